"""The check that the real time of day is still what a running behaviour assumes."""

import time
from collections.abc import Callable

from lumen.language.causes import Cause
from lumen.language.events import CLOCK_SET, Event
from lumen.statechart import Snapshot

TOLERANCE = 1.0
"""Difference [s] that is ignored, because ticks may be late, and a simulation slower than real time."""


class WallClockWatch:
    """A comparison of the exhibition's time and time zone with this machine's clock and the project's time zone.

    `timezone` returns the project's. Unless the exhibition runs in real time (`real`), it has a time of day of its own,
    and only the time zones are compared.
    """

    def __init__(self, timezone: Callable[[], str], *, real: bool, clock: Callable[[], float] = time.time) -> None:
        self._timezone, self._real, self._clock = timezone, real, clock

    def tick(self, now: float, snapshot: Snapshot) -> Event | None:
        """Return the event for the behaviour if its time of day changed at `now` [s], else None."""
        epoch, zone = snapshot.epoch, self._timezone()
        if self._real and abs(self._clock() - now - epoch) > TOLERANCE:
            epoch = self._clock() - now
        if (epoch, zone) == (snapshot.epoch, snapshot.timezone):
            return None
        return Event(CLOCK_SET, {"epoch": epoch, "timezone": zone}, now, CLOCK_SET, Cause("timer", CLOCK_SET))
