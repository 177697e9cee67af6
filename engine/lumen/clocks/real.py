"""The time of the world outside."""

import time


class RealClock:
    """Seconds since it was made."""

    def __init__(self) -> None:
        self._start = time.monotonic()

    def now(self) -> float:
        return time.monotonic() - self._start

    def wait(self, until: float) -> None:
        time.sleep(max(0.0, until - self.now()))
