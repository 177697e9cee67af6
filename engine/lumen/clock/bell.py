"""A sleep that an urgent event ends early."""

import threading
import time

SPACING = 0.02
"""Least time between two sleeps that are cut short [s], so that frequent rings give no more ticks than usual."""


class Bell:
    """A bell that any thread may ring; it ends the current sleep, or else the next one."""

    def __init__(self) -> None:
        self._rung = threading.Event()
        self._woke = -SPACING

    def ring(self) -> None:
        """End the current sleep, or else the next one."""
        self._rung.set()

    def sleep(self, seconds: float) -> None:
        """Sleep for `seconds` [s], or until the bell rings."""
        now = time.monotonic()
        if (deaf := min(seconds, self._woke + SPACING - now)) > 0:
            time.sleep(deaf)
            seconds -= deaf
        if seconds > 0 and self._rung.wait(seconds):
            self._woke = time.monotonic()
        self._rung.clear()
