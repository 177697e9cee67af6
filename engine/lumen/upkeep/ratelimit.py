"""How many messages a second are taken under one key, known before anything of a body is read."""

import time
from collections.abc import Callable

BURST = 5.0
"""For how long a silence counts [s]."""
MAX_KEYS = 10_000
"""Keys that are counted at a time; beyond that counting begins anew."""
MAX_SENDERS = 16
"""The most senders of a key that are counted separately at a time; further ones are counted as one."""


class RateLimiter:
    """A token bucket for each key: after a silence as many may come at once as else in `BURST` seconds."""

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self._buckets: dict[str, list[float]] = {}
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
        """0 where one more is not too much, and counts; else how long it is until the next is not [s]."""
        now, most = self._clock(), max(BURST * rate, 1.0)
        if len(self._buckets) > MAX_KEYS:
            self._buckets.clear()
        bucket = self._buckets.setdefault(key, [most, now])
        tokens = min(most, bucket[0] + rate * (now - bucket[1]))
        bucket[1] = now
        if tokens >= 1.0:
            bucket[0] = tokens - 1.0
            return 0.0
        bucket[0] = tokens
        return (1.0 - tokens) / rate
