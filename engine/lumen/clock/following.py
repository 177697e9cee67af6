"""The time of a robot in another process: timers of a behaviour there and what the robot does here share one time."""

import time
from collections import deque
from collections.abc import Callable

from lumen.clock.bell import Bell

WINDOW = 5.0
"""Over how long the robot's pace is measured [s]."""
MIN_MEASURED = 1.0
"""How long it has to be measured to count [s]."""
SILENCE = 2.0
"""Where nothing was heard for so long [s], the time in between is not caught up with."""
CATCH_UP = 2.0
"""In how long most of a difference is caught up with [s]: time is stretched, it neither jumps nor goes back."""
SLOWEST, FASTEST = 0.05, 2.0
"""Between which times the speed it follows [1]."""


class FollowingClock:
    """Runs at `speed` times real time by itself, and as fast as the robot's clock where that is heard of (`follow`).

    What it shows is its own: between two moments as much time has passed as on the robot, or will have soon.
    """

    def __init__(self, speed: float = 1.0, monotonic: Callable[[], float] = time.monotonic) -> None:
        self.speed, self._monotonic = speed, monotonic
        self._bell = Bell()
        self._rate, self._shown, self._since = speed, 0.0, monotonic()
        self._whose = ""
        self._heard: deque[tuple[float, float]] = deque()
        self._offset = 0.0

    @property
    def realtime(self) -> float:
        """How much of the wanted speed it keeps."""
        return self._rate / self.speed

    def now(self) -> float:
        return self._shown_at(self._monotonic())

    def hurry(self) -> None:
        """Let the `wait` that is going on return: something can't wait. From any thread."""
        self._bell.ring()

    def doze(self, until: float) -> float:
        """Wait until then, or until `hurry`; when that was [s]."""
        self.wait(until)
        return self.now()

    def wait(self, until: float) -> None:
        self._bell.sleep(max(0.0, (until - self.now()) / self._rate))

    def follow(self, whose: str, robots: float, at: float) -> None:
        """At `at` [s, monotonic] the clock of the robot of that session showed `robots` [s]."""
        last = self._heard[-1] if self._heard else None
        if last and whose == self._whose and at <= last[0]:
            return
        if last is None or whose != self._whose or at - last[0] > SILENCE or robots < last[1]:
            self._heard.clear()
            self._whose, self._offset = whose, self._shown_at(at) - robots
        self._heard.append((at, robots))
        while at - self._heard[0][0] > WINDOW:
            self._heard.popleft()
        behind = robots + self._offset - self._shown_at(at)
        self._run_at(self._pace() + behind / CATCH_UP)

    def tick(self) -> None:
        """Run by itself where the robot was not heard of for long."""
        if self._heard and self._monotonic() - self._heard[-1][0] > SILENCE:
            self._heard.clear()
            self._run_at(self.speed)

    def _pace(self) -> float:
        (first, began), (last, ended) = self._heard[0], self._heard[-1]
        return (ended - began) / (last - first) if last - first >= MIN_MEASURED else self.speed

    def _run_at(self, rate: float) -> None:
        at = self._monotonic()
        self._shown, self._since = self._shown_at(at), at
        self._rate = min(max(rate, SLOWEST * self.speed), FASTEST * self.speed)

    def _shown_at(self, at: float) -> float:
        return self._shown + (at - self._since) * self._rate
