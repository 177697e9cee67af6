"""Time that a simulated world lives through."""

import time
from collections.abc import Callable


class SimulatedClock:
    """A clock whose passing is `live(dt)`: physics, or nothing but counting.

    `speed` is how many times real time it runs at most, None as fast as the world can. Where the world is slower than
    that, the clock falls behind and does not hurry to catch up.
    """

    def __init__(self, live: Callable[[float], None], speed: float | None = None) -> None:
        self._live = live
        self._speed = speed
        self._now = 0.0
        self._due = time.monotonic()

    def now(self) -> float:
        return self._now

    def wait(self, until: float) -> None:
        dt = until - self._now
        if dt <= 0:
            return
        self._live(dt)
        self._now = until
        if self._speed:
            self._due += dt / self._speed
            ahead = self._due - time.monotonic()
            if ahead > 0:
                time.sleep(ahead)
            else:
                self._due -= ahead
