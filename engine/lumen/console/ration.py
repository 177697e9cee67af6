"""How many requests an address may send; what lets a robot rest is never counted."""

import time
from collections import OrderedDict

MAX_REQUESTS, PER_SECOND = 300.0, 60.0
"""So many at once, then so many a second."""
MAX_STREAMS = 300
"""Streams that are open at a time, of everybody."""
MAX_ADDRESSES = 1_000


class RequestRation:
    """Counts requests by the addresses that they come from."""

    def __init__(self) -> None:
        self._left: OrderedDict[str, tuple[float, float]] = OrderedDict()
        self.streams = 0

    def take(self, address: str) -> bool:
        """Whether one more may be answered now."""
        now = time.monotonic()
        left, at = self._left.pop(address, (MAX_REQUESTS, now))
        left = min(MAX_REQUESTS, left + (now - at) * PER_SECOND)
        self._left[address] = (left - 1.0 if left >= 1.0 else left), now
        while len(self._left) > MAX_ADDRESSES:
            self._left.popitem(last=False)
        return left >= 1.0
