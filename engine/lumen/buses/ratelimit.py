"""How many messages of telemetry a second are handed on under one key."""

import logging
import time

MAX_RATE = 2_000.0
"""Messages a second; a camera has 30, and a fault in a loop thousands."""
MAX_BURST = 5_000.0
"""Messages that may come at once after a silence."""
MAX_KEYS = 10_000
"""Keys that are counted at a time; beyond that counting begins anew."""

_log = logging.getLogger(__name__)


class RateLimiter:
    """A token bucket for each key, filled with `MAX_RATE` tokens a second; a message takes one, or is not handed on."""

    def __init__(self) -> None:
        self._buckets: dict[str, list[float]] = {}

    def allows(self, key: str) -> bool:
        """Whether one more is not too much; the first that is, is logged."""
        now = time.monotonic()
        if len(self._buckets) > MAX_KEYS:
            self._buckets.clear()
        bucket = self._buckets.setdefault(key, [MAX_BURST, now])
        before = bucket[0]
        bucket[0] = min(MAX_BURST, before + MAX_RATE * (now - bucket[1]))
        bucket[1] = now
        if bucket[0] >= 1.0:
            bucket[0] -= 1.0
            return True
        if before >= 1.0:
            _log.warning("more than %d messages a second come on `%s`: the rest is dropped", MAX_RATE, key)
        return False
