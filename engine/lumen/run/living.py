"""The loop of a process: ticks, and sleep while nothing is due, until it is over."""

import sys
from collections.abc import Callable
from math import inf
from typing import Protocol

from lumen.run.watcher import SWITCH_INTERVAL

ROUNDING = 1e-6
"""The tolerance for the rounding error in the sum of many ticks [s]."""


class Living(Protocol):
    """One robot of this process, or all its robots."""

    @property
    def now(self) -> float:
        """The time of the robot, or of all robots [s]."""
        ...

    @property
    def over(self) -> bool:
        """Whether the robot, or each of the robots, has ended."""
        ...

    def nap(self, most: float) -> None:
        """Sleep through ticks in which nothing happens, for at most `most` [s]."""
        ...

    def tick(self) -> float:
        """Run one tick; return its time [s]."""
        ...


def live(one: Living, period: float | None, tidy: Callable[[], None]) -> float:
    """Tick until `one` is over or `period` [s] has passed (None: no limit); return how long it ran [s].

    `tidy` is called after each tick, when the most time is left until the next one.
    """
    began, usual = one.now, sys.getswitchinterval()
    sys.setswitchinterval(SWITCH_INTERVAL)
    try:
        while not one.over and (period is None or one.now - began < period - ROUNDING):
            one.nap(inf if period is None else began + period - one.now)
            one.tick()
            tidy()
    finally:
        sys.setswitchinterval(usual)
    return one.now - began
