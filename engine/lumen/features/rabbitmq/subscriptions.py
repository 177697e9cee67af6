"""Subscriptions over AMQP, and their deliveries."""

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
    """A pattern, its handler, and its queue on the broker."""

    pattern: str
    handler: MessageHandler | None
    """The function that receives the messages; None while the queue is only prepared and gathers them."""
    route: Route | None = None
    number: int = 0
    """A number from 0 that distinguishes subscriptions to the same pattern."""
    exchange: str = EXCHANGE
    active: bool = True
    """Whether the subscription has not been removed."""
    queue: str = ""
    """The queue's name on the broker; empty before it is declared."""
    tag: str = ""
    """The consumer's tag on the broker; empty without a consumer."""
    refusal: str = ""
    """The broker's reason for refusing the subscription; empty without a refusal."""
    epoch: int = 0
    """The number of the connection that bound the queue, counted from 1; 0 for none."""
    received: int = 0
    """The number of deliveries."""
    taken: int = 0
    """The number of deliveries within the route's rate."""
    handled: int = 0
    """The number of `taken` deliveries that have been handled."""
    dropped: int = 0
    """The number of deliveries that exceeded the rate."""
    bound: threading.Event = field(default_factory=threading.Event)
    """Set when the broker has answered, or if it is away."""

    @property
    def must_arrive(self) -> bool:
        """Whether the subscription's messages must arrive, by its route."""
        return self.route is not None and self.route.must_arrive


class Delivery(NamedTuple):
    """A message as it was received."""

    subscription: Subscription
    key: str
    body: bytes
    properties: MessageProperties
    number: int
    """The broker's number for the acknowledgement."""
    epoch: int
    """The number of the receiving connection, which alone can acknowledge the delivery."""
    again: bool = False
    """Whether the broker may have sent it before."""
    at: float = 0.0
    """The time of its arrival [s, monotonic]."""
    spent: bool = False
    """Whether the delivery only needs acknowledgement, because its message was dropped."""


class Subscriptions:
    """The subscriptions of one connection, and the prepared ones, whose keys have no handler yet.

    Its methods can be called from any thread and do not block.
    """

    def __init__(self) -> None:
        self._active: list[Subscription] = []
        self._prepared: dict[str, Subscription] = {}
        self._changing = threading.Lock()

    def active(self) -> list[Subscription]:
        """Return the subscriptions with a handler, in the order subscribed."""
        with self._changing:
            return list(self._active)

    def all(self) -> list[Subscription]:
        """Return the subscriptions with a handler, then the prepared ones."""
        with self._changing:
            return [*self._active, *self._prepared.values()]

    def add(self, pattern: str, handler: MessageHandler, route: Route | None, exchange: str = EXCHANGE) -> Subscription:
        """Add a subscription, with the first free `number` for its pattern, and return it."""
        with self._changing:
            numbers = {s.number for s in self._active if s.pattern == pattern}
            number = next(n for n in range(len(numbers) + 1) if n not in numbers)
            subscription = Subscription(pattern, handler, route, number, exchange)
            self._active.append(subscription)
        return subscription

    def claim(self, pattern: str, handler: MessageHandler) -> Subscription | None:
        """Set the handler of the pattern's prepared and bound subscription, and return it; None if it is missing."""
        with self._changing:
            subscription = self._prepared.pop(pattern, None)
            if subscription is None or not subscription.bound.is_set() or subscription.refusal:
                return None
            subscription.handler = handler
            self._active.append(subscription)
        return subscription

    def prepare(self, routes: Mapping[str, Route]) -> tuple[list[Subscription], list[Subscription]]:
        """Prepare subscriptions for those of these keys that have no handler.

        Return all prepared subscriptions, and the earlier prepared ones that are no longer needed.
        """
        with self._changing:
            taken = {s.pattern for s in self._active}
            old, self._prepared = self._prepared, {}
            for key in routes.keys() - taken:
                self._prepared[key] = old.pop(key) if key in old else Subscription(key, None, routes[key])
            return list(self._prepared.values()), list(old.values())

    def remove(self, subscription: Subscription) -> bool:
        """Deactivate a subscription; return False if it is inactive already."""
        with self._changing:
            if not subscription.active:
                return False
            subscription.active = False
            self._active.remove(subscription)
        return True

    def refuse(self, subscription: Subscription, reason: str) -> None:
        """Record that the broker refuses a subscription, prepared or not, and remove it."""
        subscription.refusal, subscription.active = reason, False
        with self._changing:
            if subscription in self._active:
                self._active.remove(subscription)
            self._prepared.pop(subscription.pattern, None)
