"""Real time."""

import time

from lumen.clock.bell import Bell


class RealClock:
    """The seconds since it was made, plus the initial `now` [s].

    At a `speed` other than 1 they are that many times shorter, for processes that share the time of a simulation of
    that speed.
    """

    realtime = 1.0

    def __init__(self, now: float = 0.0, speed: float = 1.0) -> None:
        self._start, self.speed = time.monotonic() - now / speed, speed
        self._bell = Bell()

    def now(self) -> float:
        """Return the clock's time [s]."""
        return (time.monotonic() - self._start) * self.speed

    def hurry(self) -> None:
        """End the current `wait`, for something urgent; any thread may call it."""
        self._bell.ring()

    def doze(self, until: float) -> float:
        """Wait until `until` [s], or until `hurry`; return the time [s]."""
        self.wait(until)
        return self.now()

    def wait(self, until: float) -> None:
        """Wait until `until` [s], or until `hurry`."""
        self._bell.sleep(max(0.0, (until - self.now()) / self.speed))
