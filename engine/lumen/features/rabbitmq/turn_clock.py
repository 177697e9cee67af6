"""When a message came that is read only now: a process that stood still finds it in its socket."""

import time
from collections.abc import Callable

STALL_TIME = 0.5
"""By how much a turn may take longer [s] before this process counts as having stood still."""


class TurnClock:
    """Follows the turns of a connection.

    Who wakes up in the middle of a turn may see only in the next one what came in this one: both count from its begin.
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self._begun, self._most = clock(), 0.0
        self._stood_since: float | None = None

    def begin(self, most: float) -> None:
        """A turn begins, which takes `most` [s]."""
        now = self._clock()
        self._stood_since = self._begun if self._stood(now) else None
        self._begun, self._most = now, most

    def arrival(self) -> float:
        """When what is received now came at the earliest [s, by `clock`]: now, unless this process stood still."""
        now = self._clock()
        if self._stood_since is not None:
            return self._stood_since
        return self._begun if self._stood(now) else now

    def _stood(self, now: float) -> bool:
        return now - self._begun > self._most + STALL_TIME
