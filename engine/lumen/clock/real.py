"""The time of the world outside."""

import time

from lumen.clock.bell import Bell


class RealClock:
    """Seconds since it was made, and those that it began with: `now` [s].

    At another `speed` than 1 they are that many times shorter, for processes around a simulation that is as fast.
    """

    realtime = 1.0

    def __init__(self, now: float = 0.0, speed: float = 1.0) -> None:
        self._start, self.speed = time.monotonic() - now / speed, speed
        self._bell = Bell()

    def now(self) -> float:
        return (time.monotonic() - self._start) * self.speed

    def hurry(self) -> None:
        """Let the `wait` that is going on return: something can't wait. From any thread."""
        self._bell.ring()

    def doze(self, until: float) -> float:
        """Wait until then, or until `hurry`; when that was [s]."""
        self.wait(until)
        return self.now()

    def wait(self, until: float) -> None:
        self._bell.sleep(max(0.0, (until - self.now()) / self.speed))
