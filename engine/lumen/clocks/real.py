"""The time of the world outside."""

import time


class RealClock:
    """Seconds since it was made, and those that it began with: `now` [s].

    At another `speed` than 1 they are that many times shorter, for processes around a simulation that is as fast.
    """

    def __init__(self, now: float = 0.0, speed: float = 1.0) -> None:
        self._start, self._speed = time.monotonic() - now / speed, speed

    def now(self) -> float:
        return (time.monotonic() - self._start) * self._speed

    def wait(self, until: float) -> None:
        time.sleep(max(0.0, (until - self.now()) / self._speed))
