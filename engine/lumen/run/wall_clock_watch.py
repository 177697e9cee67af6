"""The check that the real time of day is still what a running behaviour assumes."""

import time
from collections.abc import Callable

from lumen.language.causes import Cause
from lumen.language.events import CLOCK_SET, Event
from lumen.statechart import Snapshot

TOLERANCE = 1.0
"""The difference that is ignored [s], because ticks may be late, and a simulation slower than real time."""
READINGS = 5
"""The greatest number of attempts to read both clocks without a suspension of the process in between."""


def date_of_zero(now: Callable[[], float], wall: Callable[[], float]) -> float:
    """Return the date [s since 1970] of time 0 of the clock `now` [s], by the machine's clock `wall`.

    If the process is suspended between its readings of the two clocks, the result would be wrong. So `now` is read
    before and after `wall`; if too much time passed, both are read again, at most `READINGS` times.
    """
    for _ in range(READINGS):
        before, date, after = now(), wall(), now()
        if after - before <= TOLERANCE / 2:
            break
    return date - after


class WallClockWatch:
    """A comparison of the exhibition's time and time zone with this machine's clock and the project's time zone.

    `timezone` returns the project's time zone. An exhibition that does not run in real time (`real`) has a time of day
    of its own, so only the time zones are compared.
    """

    def __init__(self, timezone: Callable[[], str], *, real: bool, clock: Callable[[], float] = time.time) -> None:
        self._timezone, self._real, self._clock = timezone, real, clock

    def tick(self, now: Callable[[], float], snapshot: Snapshot) -> Event | None:
        """Return the event that sets the behaviour's time of day, if that is no longer right; else None.

        `now` returns the exhibition's time [s].
        """
        epoch, zone = snapshot.epoch, self._timezone()
        if self._real and abs((found := date_of_zero(now, self._clock)) - epoch) > TOLERANCE:
            epoch = found
        if (epoch, zone) == (snapshot.epoch, snapshot.timezone):
            return None
        return Event(CLOCK_SET, {"epoch": epoch, "timezone": zone}, now(), CLOCK_SET, Cause("timer", CLOCK_SET))
