"""The time of a simulated world."""

import time
from collections import deque
from collections.abc import Callable

from lumen.clock.bell import Bell
from lumen.language.nanoseconds import to_the_nanosecond

WINDOW = 10.0
"""Interval over which the pace is measured [s]."""
MIN_MEASURED = 2.0
"""Least interval for a measurement [s]."""
SAMPLE_PERIOD = 0.25
"""Time between two samples [s]."""


class PaceMeter:
    """A meter of a clock's recent pace, relative to the `speed` that it should have."""

    def __init__(self, speed: float, clock: Callable[[], float] = time.monotonic) -> None:
        self._speed, self._clock = speed, clock
        self._noted: deque[tuple[float, float]] = deque(maxlen=round(WINDOW / SAMPLE_PERIOD))

    def note(self, now: float) -> None:
        """Record that the clock shows `now` [s]."""
        at = self._clock()
        if not self._noted or at - self._noted[-1][0] >= SAMPLE_PERIOD:
            self._noted.append((at, now))

    @property
    def factor(self) -> float:
        """The share of its speed that the clock kept; 1 until enough has been measured."""
        if len(self._noted) < 2:
            return 1.0
        (first, began), (last, ended) = self._noted[0], self._noted[-1]
        return (ended - began) / (last - first) / self._speed if last - first >= MIN_MEASURED else 1.0


MAX_ARREARS = 0.25
"""The greatest delay that the clock makes up for [s], so that a tick delayed by the machine costs no time."""


class SimulatedClock:
    """A clock that advances a world by `live(dt)`: physics, or just counting.

    `speed` is the fastest pace in multiples of real time, None for no limit. If the world is slower, the clock falls
    behind and makes up for at most `MAX_ARREARS`.
    """

    def __init__(
        self,
        live: Callable[[float], None],
        speed: float | None = None,
        monotonic: Callable[[], float] = time.monotonic,
    ) -> None:
        self._live, self.speed, self._monotonic = live, speed, monotonic
        self._meter = PaceMeter(speed or 1.0, monotonic)
        self._bell = Bell()
        self._now = 0.0
        self._due = monotonic()

    @property
    def realtime(self) -> float:
        """The share of its speed that the clock has kept recently; 1 if the speed has no limit."""
        return self._meter.factor if self.speed else 1.0

    def now(self) -> float:
        """Return the clock's time [s]."""
        return self._now

    def hurry(self) -> None:
        """End the current `wait`, for something urgent; any thread may call it."""
        self._bell.ring()

    def doze(self, until: float) -> float:
        """Sleep until the world is due to advance to `until` [s], or until `hurry`.

        Return the time up to which it is due now, at most `until` [s]. Without a speed limit it returns at once.
        """
        if not self.speed:
            return self._now
        self._bell.sleep(max(0.0, self._due + (until - self._now) / self.speed - self._monotonic()))
        return min(until, self._now + max(0.0, self._monotonic() - self._due) * self.speed)

    def wait(self, until: float) -> None:
        """Advance the world to `until` [s], and sleep until that time is due, or until `hurry`."""
        until = to_the_nanosecond(until)
        dt = until - self._now
        if dt <= 0:
            return
        self._live(dt)
        self._now = until
        if self.speed:
            self._due += dt / self.speed
            ahead = self._due - self._monotonic()
            if ahead > 0:
                self._bell.sleep(ahead)
            else:
                self._due += max(0.0, -ahead - MAX_ARREARS)
            self._meter.note(until)
