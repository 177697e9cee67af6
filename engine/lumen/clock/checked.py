"""A clock of an installed package: its faults, and times of a wrong type, are errors that name the package."""

from collections.abc import Callable
from functools import partial
from typing import TypeVar

from lumen.clock.real import RealClock
from lumen.clock.simulated import SimulatedClock
from lumen.errors import LumenError
from lumen.language.numbers import is_finite_number
from lumen.ports import Clock, Dozes, HasSpeed, MeasuresPace
from lumen.project.broken_features import faults_named, shown

Ability = TypeVar("Ability")


class CheckedClock:
    """A wrapper that passes everything on to `clock`; `fault` makes an error of words such as "returned None from …".

    Raises that error if the clock does not return a time, or if its `speed` is not a number.
    """

    def __init__(self, clock: Clock, fault: Callable[[str], LumenError]) -> None:
        self.clock, self._fault = clock, fault
        self.now()
        if isinstance(clock, HasSpeed) and not (clock.speed is None or is_finite_number(clock.speed)):
            raise fault(f"has the speed {shown(clock.speed)}: it must be a number or None")

    @property
    def realtime(self) -> float:
        """The share of its speed that the clock keeps, 1 if it does not measure that."""
        clock = self.clock
        return self._number("realtime", lambda: clock.realtime) if isinstance(clock, MeasuresPace) else 1.0

    def now(self) -> float:
        """Return the clock's time [s]."""
        return self._number("now", self.clock.now)

    def wait(self, until: float) -> None:
        """Wait until a time on the clock [s]."""
        with faults_named(self._fault, "wait"):
            self.clock.wait(until)

    def _number(self, method: str, call: Callable[[], float]) -> float:
        with faults_named(self._fault, method):
            found = call()
        if not is_finite_number(found):
            raise self._fault(f"returned {shown(found)} from `{method}`: it must return a finite number")
        return found


class CheckedDozingClock(CheckedClock):
    """A checked clock that can sleep."""

    def __init__(self, clock: Clock, dozes: Dozes, fault: Callable[[str], LumenError]) -> None:
        super().__init__(clock, fault)
        self._dozes = dozes

    def doze(self, until: float) -> float:
        """Sleep until a time [s] or until `hurry`; return the time [s]."""
        return self._number("doze", partial(self._dozes.doze, until))

    def hurry(self) -> None:
        """End the current wait."""
        with faults_named(self._fault, "hurry"):
            self._dozes.hurry()


def checked_clock(clock: Clock, fault: Callable[[str], LumenError]) -> Clock:
    """Return the clock with checks, one of Lumen's unchanged. Raises the error of `fault` as CheckedClock does."""
    if isinstance(clock, RealClock | SimulatedClock):
        return clock
    return CheckedDozingClock(clock, clock, fault) if isinstance(clock, Dozes) else CheckedClock(clock, fault)


def ability(clock: Clock, kind: type[Ability]) -> Ability | None:
    """Return the clock itself (or the one beneath the checks) if it has an ability, else None."""
    own = clock.clock if isinstance(clock, CheckedClock) else clock
    return own if isinstance(own, kind) else None
