"""Tells when an exhibition can't keep the time that it should."""

import time
from collections.abc import Callable

from lumen.ports import Clock, MeasuresPace

SLOW, WELL = 0.95, 0.98
"""Under which part of its speed time is slow, and above which it is well again [1]."""
LOOK_PERIOD = 1.0
"""How often it is looked at [s]."""


class PaceWatch:
    """Watches a clock that says how much of its speed it keeps (`realtime`); one that does not, keeps all of it.

    `tick` returns a line when that falls under `SLOW`, and one when it is above `WELL` again; `worst` is the least.
    """

    def __init__(self, clock: Clock, monotonic: Callable[[], float] = time.monotonic) -> None:
        self._clock, self._monotonic, self._next = clock, monotonic, 0.0
        self.slow, self.worst = False, 1.0

    @property
    def realtime(self) -> float:
        """How much of its speed the clock keeps, of late; never above 1."""
        return round(min(1.0, self._clock.realtime if isinstance(self._clock, MeasuresPace) else 1.0), 3)

    def tick(self) -> str:
        if self._monotonic() < self._next:
            return ""
        self._next = self._monotonic() + LOOK_PERIOD
        now = self.realtime
        self.worst = min(self.worst, now)
        if not self.slow and now < SLOW:
            self.slow = True
            return (
                f"the exhibition is running at only {now:.2f} × real time:"
                " this machine is too slow or too busy, so everything is late"
            )
        if self.slow and now > WELL:
            self.slow = False
            return "the exhibition is running in real time again"
        return ""

    def summary(self) -> list[str]:
        """What is said of it at the end."""
        return [f"at its slowest, the exhibition ran at {self.worst:.2f} × real time"] if self.worst < SLOW else []
