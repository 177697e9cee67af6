"""How well a clock keeps up with the time of the world outside."""

import time
from collections import deque
from collections.abc import Callable

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
