"""The time of the world outside."""

import time


class RealClock:
    """Seconds since it was made, and those that it began with: `now` [s]."""

    def __init__(self, now: float = 0.0) -> None:
        self._start = time.monotonic() - now

    def now(self) -> float:
        return time.monotonic() - self._start

    def wait(self, until: float) -> None:
        time.sleep(max(0.0, until - self.now()))
