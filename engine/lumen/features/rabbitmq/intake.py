"""Limits the rate of deliveries, and drops excess messages cheaply in a flood."""

import logging
from collections.abc import Callable

from lumen.features.rabbitmq.subscriptions import Delivery
from lumen.upkeep.drops import DropLog
from lumen.upkeep.ratelimit import RateLimiter

ANSWERED_RATE = 10.0
"""The maximum rate, for each key, at which dropped messages that must arrive are answered and put aside [1/s].

Further dropped messages are only counted.
"""
SPENT_BATCH = 32
"""The number of dropped messages after which they are acknowledged; at most half of the prefetch limit."""

_log = logging.getLogger(__name__)

Later = Callable[[float, Callable[[], None]], object]
"""A function that calls the given function on the same thread after a delay [s]."""


class Intake:
    """Passes at most as many deliveries per second to `receive` as their route accepts (`Route.rate`).

    All methods run on one thread. Messages that must arrive are limited per sender, so one sender can't crowd out
    another's commands. Keys without a route have no limit. Excess telemetry is dropped except the newest message, which
    holds the current values and waits until the rate allows it (`later`). Excess messages that must arrive are dropped,
    and some of them are passed to `refused` with the reason. `drops` counts dropped messages by key.
    """

    def __init__(
        self, receive: Callable[[Delivery], None], refused: Callable[[Delivery, str], None], later: Later
    ) -> None:
        self.drops = DropLog(_log)
        self.flooded = False
        self._receive, self._refused, self._later = receive, refused, later
        self._limiter, self._answers = RateLimiter(), RateLimiter()
        self._held: dict[tuple[int, str], Delivery] = {}

    def take(self, delivery: Delivery) -> None:
        """Pass a delivery on, hold it back, or drop it."""
        route = delivery.subscription.route
        rate = route.rate if route else 0.0
        wait = self._wait(delivery, rate) if rate else 0.0
        place = (id(delivery.subscription), delivery.key)
        if not wait:
            if older := self._held.pop(place, None):
                self._drop(older, rate)
            self._pass(delivery)
        elif delivery.subscription.must_arrive:
            self._drop(delivery, rate)
        else:
            self._hold(place, delivery, wait, rate)

    def forget(self) -> None:
        """Forget the held deliveries after a lost connection; the broker deleted them with their queues."""
        self._held.clear()

    def _wait(self, delivery: Delivery, rate: float) -> float:
        if not delivery.subscription.must_arrive:
            return self._limiter.wait(delivery.key, rate)
        return self._limiter.wait(self._limiter.apart(delivery.key, delivery.properties.app_id), rate)

    def _pass(self, delivery: Delivery) -> None:
        delivery.subscription.taken += 1
        self._receive(delivery)

    def _hold(self, place: tuple[int, str], delivery: Delivery, wait: float, rate: float) -> None:
        older, self._held[place] = self._held.get(place), delivery
        if older:
            self._drop(older, rate)
        else:
            self._later(wait, lambda: self._release(place))

    def _release(self, place: tuple[int, str]) -> None:
        if delivery := self._held.pop(place, None):
            self.take(delivery)

    def _drop(self, delivery: Delivery, rate: float) -> None:
        self.flooded = True
        subscription = delivery.subscription
        why = f"more than {rate:g} messages a second arrive"
        self.drops.add(delivery.key, why)
        if subscription.must_arrive and not self._answers.wait(delivery.key, ANSWERED_RATE):
            self._refused(delivery, why)
        subscription.dropped += 1
        if subscription.dropped % SPENT_BATCH == 0:
            self._pass(delivery._replace(spent=True))
