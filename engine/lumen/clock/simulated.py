"""Time that a simulated world lives through."""

import time
from collections import deque
from collections.abc import Callable

from lumen.clock.bell import Bell
from lumen.language.nanoseconds import to_the_nanosecond

WINDOW = 10.0
"""Over how long the pace is measured [s]."""
MIN_MEASURED = 2.0
"""How long it has to be measured to count [s]."""
SAMPLE_PERIOD = 0.25
"""How often the time is noted [s]."""


class PaceMeter:
    """Told of a clock's time, says how fast that passed of late: 1 where it kept the `speed` that it should have."""

    def __init__(self, speed: float, clock: Callable[[], float] = time.monotonic) -> None:
        self._speed, self._clock = speed, clock
        self._noted: deque[tuple[float, float]] = deque(maxlen=round(WINDOW / SAMPLE_PERIOD))

    def note(self, now: float) -> None:
        """The clock shows `now` [s]."""
        at = self._clock()
        if not self._noted or at - self._noted[-1][0] >= SAMPLE_PERIOD:
            self._noted.append((at, now))

    @property
    def factor(self) -> float:
        """How many seconds of the wanted speed passed in each; 1 before enough is known."""
        if len(self._noted) < 2:
            return 1.0
        (first, began), (last, ended) = self._noted[0], self._noted[-1]
        return (ended - began) / (last - first) / self._speed if last - first >= MIN_MEASURED else 1.0


MAX_ARREARS = 0.25
"""How far [s] the clock may be behind and still catch up: a tick that the machine held back costs no time."""


class SimulatedClock:
    """A clock whose passing is `live(dt)`: physics, or nothing but counting.

    `speed` is how many times real time it runs at most, None as fast as the world can. Where the world is slower than
    that, the clock falls behind and, but for `MAX_ARREARS`, does not hurry to catch up; `realtime` says how slow it is.
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
        """How much of the wanted speed it has kept of late; 1 where it may be as fast as it can."""
        return self._meter.factor if self.speed else 1.0

    def now(self) -> float:
        return self._now

    def hurry(self) -> None:
        """Let the `wait` that is going on return: something can't wait. From any thread."""
        self._bell.ring()

    def doze(self, until: float) -> float:
        """Sleep until the world is to live on, or until `hurry`; until when that is due by now, at most `until` [s].

        As fast as it can there is nothing to sleep for.
        """
        if not self.speed:
            return self._now
        self._bell.sleep(max(0.0, self._due + (until - self._now) / self.speed - self._monotonic()))
        return min(until, self._now + max(0.0, self._monotonic() - self._due) * self.speed)

    def wait(self, until: float) -> None:
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
