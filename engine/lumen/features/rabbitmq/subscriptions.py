"""What is subscribed to over AMQP, and what comes of it."""

import threading
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import NamedTuple

from lumen.features.rabbitmq.properties import MessageProperties
from lumen.features.rabbitmq.queues import EXCHANGE
from lumen.language.routes import Route
from lumen.ports import MessageHandler


@dataclass(eq=False)
class Subscription:
    """A pattern, its handler, and its queue on the broker; `bound` is set once the broker has answered.

    Until there is a handler (`prepare`) the queue only gathers. `received` counts the deliveries; of them `taken` were
    not too many, and `handled` of those are done with; `dropped` were too many.
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
    taken: int = 0
    handled: int = 0
    dropped: int = 0
    bound: threading.Event = field(default_factory=threading.Event)

    @property
    def must_arrive(self) -> bool:
        return self.route is not None and self.route.must_arrive


class Delivery(NamedTuple):
    """A message as it came at `at` [s, monotonic], `again` where the broker may have sent it before.

    One that is `spent` is only to be acknowledged, in its turn. `number` and `epoch` say what to acknowledge.
    """

    subscription: Subscription
    key: str
    body: bytes
    properties: MessageProperties
    number: int
    epoch: int
    again: bool = False
    at: float = 0.0
    spent: bool = False


class Subscriptions:
    """The subscriptions of one connection, and those that are prepared: nobody has subscribed to these keys yet.

    Safe from any thread; nothing here waits.
    """

    def __init__(self) -> None:
        self._active: list[Subscription] = []
        self._prepared: dict[str, Subscription] = {}
        self._changing = threading.Lock()

    def active(self) -> list[Subscription]:
        """Those that have a handler, in the order subscribed."""
        with self._changing:
            return list(self._active)

    def all(self) -> list[Subscription]:
        """Those that have a handler, then the prepared ones."""
        with self._changing:
            return [*self._active, *self._prepared.values()]

    def add(self, pattern: str, handler: MessageHandler, route: Route | None, exchange: str = EXCHANGE) -> Subscription:
        """A new one; its `number` tells it from others of the same pattern."""
        with self._changing:
            numbers = {s.number for s in self._active if s.pattern == pattern}
            number = next(n for n in range(len(numbers) + 1) if n not in numbers)
            subscription = Subscription(pattern, handler, route, number, exchange)
            self._active.append(subscription)
        return subscription

    def claim(self, pattern: str, handler: MessageHandler) -> Subscription | None:
        """The prepared one of this pattern, which has this handler from now on; None where none is bound."""
        with self._changing:
            subscription = self._prepared.pop(pattern, None)
            if subscription is None or not subscription.bound.is_set() or subscription.refusal:
                return None
            subscription.handler = handler
            self._active.append(subscription)
        return subscription

    def prepare(self, routes: Mapping[str, Route]) -> tuple[list[Subscription], list[Subscription]]:
        """Those that are prepared for these keys now, and those prepared before that no key needs any more."""
        with self._changing:
            taken = {s.pattern for s in self._active}
            old, self._prepared = self._prepared, {}
            for key in routes.keys() - taken:
                self._prepared[key] = old.pop(key) if key in old else Subscription(key, None, routes[key])
            return list(self._prepared.values()), list(old.values())

    def remove(self, subscription: Subscription) -> bool:
        """Deactivate it; false where it is inactive already."""
        with self._changing:
            if not subscription.active:
                return False
            subscription.active = False
            self._active.remove(subscription)
        return True

    def refuse(self, subscription: Subscription, reason: str) -> None:
        """The broker refuses it: it is gone, prepared or not."""
        subscription.refusal, subscription.active = reason, False
        with self._changing:
            if subscription in self._active:
                self._active.remove(subscription)
            self._prepared.pop(subscription.pattern, None)
