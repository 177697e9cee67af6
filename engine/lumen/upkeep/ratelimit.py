"""Limits on messages or requests per second, counted by key."""

import time
from collections import OrderedDict
from collections.abc import Callable
from dataclasses import dataclass

BURST = 5.0
"""Length of the silence that can be made up for at once [s]."""
MAX_KEYS = 10_000
"""Keys that are counted at a time, those used last."""
MAX_SENDERS = 16
"""Senders of a key that are counted separately at a time; further ones are counted together."""


@dataclass(slots=True)
class TokenBucket:
    """Tokens that are used one by one and come back with time. Times are those of one clock [s]."""

    tokens: float
    since: float

    def wait(self, now: float, rate: float, most: float) -> float:
        """Return the time until there is a token [s], 0 if there is one; `rate` per second come back, up to `most`."""
        self.tokens, self.since = min(most, self.tokens + rate * (now - self.since)), now
        return 0.0 if self.tokens >= 1.0 else (1.0 - self.tokens) / rate


class RateLimiter:
    """A token bucket for each key: after a silence it allows at once what it otherwise allows in `BURST`."""

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self._buckets: OrderedDict[str, TokenBucket] = OrderedDict()
        self._senders: dict[str, dict[str, float]] = {}

    def apart(self, key: str, sender: str) -> str:
        """The key under which a sender's messages are counted: a separate one, unless too many others sent recently."""
        if len(self._senders) > MAX_KEYS:
            self._senders.clear()
        now, senders = self._clock(), self._senders.setdefault(key, {})
        if sender not in senders and len(senders) >= MAX_SENDERS:
            for quiet in [name for name, last in senders.items() if now - last > BURST]:
                del senders[quiet]
            if len(senders) >= MAX_SENDERS:
                return key
        senders[sender] = now
        return f"{key} {sender}"

    def wait(self, key: str, rate: float) -> float:
        """Count one and return 0 if it is within `rate` per second; else return the time until the next one is [s]."""
        now, most = self._clock(), max(BURST * rate, 1.0)
        if (bucket := self._buckets.get(key)) is None:
            bucket = self._buckets[key] = TokenBucket(most, now)
            if len(self._buckets) > MAX_KEYS:
                self._buckets.popitem(last=False)
        else:
            self._buckets.move_to_end(key)
        if left := bucket.wait(now, rate, most):
            return left
        bucket.tokens -= 1.0
        return 0.0
