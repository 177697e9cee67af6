"""What is subscribed to over AMQP, and what comes of it."""

import threading
from dataclasses import dataclass, field
from typing import Any, NamedTuple

from lumen.buses.queues import EXCHANGE
from lumen.language.routes import Route
from lumen.ports import MessageHandler


@dataclass(eq=False)
class Subscription:
    """A pattern, its handler, and its queue on the broker; `bound` is set once the broker has answered.

    Until there is a handler (`prepared`) the queue only gathers. `received` and `handled` count the deliveries.
    """

    pattern: str
    handler: MessageHandler | None
    route: Route | None = None
    number: int = 0
    exchange: str = EXCHANGE
    active: bool = True
    queue: str = ""
    tag: str = ""
    refusal: str = ""
    epoch: int = 0
    received: int = 0
    handled: int = 0
    bound: threading.Event = field(default_factory=threading.Event)

    @property
    def must_arrive(self) -> bool:
        return self.route is not None and self.route.must_arrive


class Delivery(NamedTuple):
    """A message as it came at `at` [s, monotonic], `again` where the broker may have sent it before.

    `number` and `epoch` say what to acknowledge.
    """

    subscription: Subscription
    key: str
    body: bytes
    properties: Any
    number: int
    epoch: int
    again: bool = False
    at: float = 0.0
