"""The loop of a process: tick by tick, asleep while nothing is due, until it is over."""

import sys
from collections.abc import Callable
from math import inf
from typing import Protocol

from lumen.run.watcher import SWITCH_INTERVAL

ROUNDING = 1e-6
"""How far the sum of many ticks may be off [s]."""


class Living(Protocol):
    """One robot of this process, or all of them."""

    @property
    def now(self) -> float:
        """Its time [s]."""
        ...

    @property
    def over(self) -> bool: ...

    def nap(self, most: float) -> None:
        """Sleep through the ticks in which nothing happens, for at most `most` [s]."""
        ...

    def tick(self) -> float: ...


def live(one: Living, period: float | None, tidy: Callable[[], None]) -> float:
    """Tick until it is over, or has lived for the period [s]; return how long it lived [s].

    `tidy` is called after each tick, when there is the most time until the next.
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
