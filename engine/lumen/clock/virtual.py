"""A clock that passes only by `advance`, and stops at everything that is due on the way."""

from math import inf
from typing import Protocol

from lumen.errors import UsageError
from lumen.language.nanoseconds import to_the_nanosecond
from lumen.upkeep.arguments import need_number


class Sleeper(Protocol):
    """An object that is woken at certain times."""

    def next_due(self) -> float | None:
        """Return the time at which the sleeper must be woken next [s], None for never."""
        ...

    def wake(self) -> None:
        """Called when that time has come."""
        ...


class VirtualClock:
    """A clock that stands still between calls of `advance`."""

    def __init__(self, now: float = 0.0) -> None:
        need_number(now, "the time of a clock")
        self._now = to_the_nanosecond(now)
        self._sleepers: list[Sleeper] = []

    def now(self) -> float:
        """Return the clock's time [s]."""
        return self._now

    def advance(self, dt: float) -> None:
        """Let `dt` [s] pass, and wake each sleeper at its due times, in order.

        Raises UsageError if `dt` is negative, infinite or NaN.
        """
        need_number(dt, "the time to advance a clock by", finite=False)
        if not 0.0 <= dt < inf:
            raise UsageError(f"a clock cannot advance by {dt} s")
        self.wait(self._now + dt)

    def wait(self, until: float) -> None:
        """Let time pass until `until` [s], to the nanosecond, and wake sleepers on the way; ignore a past time."""
        need_number(until, "the time to wait for", finite=False)
        until = to_the_nanosecond(until)
        while (sleeper := self._first(until)) is not None:
            self._now = max(self._now, sleeper.next_due() or 0.0)
            sleeper.wake()
        self._now = max(self._now, until)

    def attach(self, sleeper: Sleeper) -> None:
        """Wake a sleeper from now on."""
        self._sleepers.append(sleeper)

    def _first(self, until: float) -> Sleeper | None:
        waiting = [(due, sleeper) for sleeper in self._sleepers if (due := sleeper.next_due()) is not None]
        due, sleeper = min(waiting, key=lambda pair: pair[0], default=(until + 1, None))
        return sleeper if due <= until else None
