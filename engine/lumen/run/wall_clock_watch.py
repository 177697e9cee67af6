"""Whether the clock on the wall still shows what a running behaviour takes it to show."""

import time
from collections.abc import Callable

from lumen.language.causes import Cause
from lumen.language.events import CLOCK_SET, Event
from lumen.statechart import Snapshot

TOLERANCE = 1.0
"""How far it may be off [s] before that is said: a tick is late at times, and a simulation slower than real time."""


class WallClockWatch:
    """Compares the exhibition's time with that of this machine's clock, and its time zone with the project's.

    `timezone` returns the one that counts. Where the exhibition does not live in real time (`real`) its own time of day
    counts, and nothing is compared.
    """

    def __init__(self, timezone: Callable[[], str], *, real: bool, clock: Callable[[], float] = time.time) -> None:
        self._timezone, self._real, self._clock = timezone, real, clock

    def tick(self, now: float, snapshot: Snapshot) -> Event | None:
        """What the behaviour has to hear of it at `now` [s], None where all is well."""
        epoch, zone = snapshot.epoch, self._timezone()
        if self._real and abs(self._clock() - now - epoch) > TOLERANCE:
            epoch = self._clock() - now
        if (epoch, zone) == (snapshot.epoch, snapshot.timezone):
            return None
        return Event(CLOCK_SET, {"epoch": epoch, "timezone": zone}, now, CLOCK_SET, Cause("timer", CLOCK_SET))
