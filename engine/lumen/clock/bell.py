"""Sleep that ends early where there is something that can't wait."""

import threading
import time

SPACING = 0.02
"""How long after one sleep was cut short the next may be [s]: who rings all the time gets no more ticks than usual."""


class Bell:
    """Rung from any thread; whoever sleeps wakes, or does not fall asleep."""

    def __init__(self) -> None:
        self._rung = threading.Event()
        self._woke = -SPACING

    def ring(self) -> None:
        self._rung.set()

    def sleep(self, seconds: float) -> None:
        """Sleep so long, or until it is rung."""
        now = time.monotonic()
        if (deaf := min(seconds, self._woke + SPACING - now)) > 0:
            time.sleep(deaf)
            seconds -= deaf
        if seconds > 0 and self._rung.wait(seconds):
            self._woke = time.monotonic()
        self._rung.clear()
