"""How fast telemetry may come under one key."""

import logging
import time

RATE = 2_000.0
"""Messages a second; a camera has 30, and a fault in a loop thousands."""
BURST = 5_000.0
KEYS = 10_000

_log = logging.getLogger(__name__)


class RateLimiter:
    """A bucket for each key that fills with `RATE` tokens a second; a message takes one, or is not handed on."""

    def __init__(self) -> None:
        self._buckets: dict[str, list[float]] = {}

    def allows(self, key: str) -> bool:
        """Whether one more is not too much; the first that is, is logged."""
        now = time.monotonic()
        if len(self._buckets) > KEYS:
            self._buckets.clear()
        bucket = self._buckets.setdefault(key, [BURST, now])
        before = bucket[0]
        bucket[0] = min(BURST, before + RATE * (now - bucket[1]))
        bucket[1] = now
        if bucket[0] >= 1.0:
            bucket[0] -= 1.0
            return True
        if before >= 1.0:
            _log.warning("more than %d messages a second come on `%s`: the rest is dropped", RATE, key)
        return False
