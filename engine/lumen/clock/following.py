"""The time of a robot in another process, so that a behaviour's timers here and the robot's actions share one time."""

import time
from collections import deque
from collections.abc import Callable

from lumen.clock.bell import Bell

WINDOW = 5.0
"""Interval over which the robot's pace is measured [s]."""
MIN_MEASURED = 1.0
"""Least interval for a measurement [s]."""
SILENCE = 2.0
"""Time without a report [s] after which the missed time is not made up for."""
CATCH_UP = 2.0
"""Time in which most of a difference is made up for [s]: the clock is stretched, and never jumps or goes back."""
SLOWEST, FASTEST = 0.05, 2.0
"""Limits of the pace, relative to the speed [1]."""


class FollowingClock:
    """A clock that runs at `speed` times real time, or at the pace of a robot's clock if reported (`follow`).

    Only intervals correspond to the robot's clock, not readings: as much time passes as on the robot, apart from a
    difference that is still made up for.
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
        """The present pace of the clock, as a share of `speed`."""
        return self._rate / self.speed

    def now(self) -> float:
        """Return the clock's time [s]."""
        return self._shown_at(self._monotonic())

    def hurry(self) -> None:
        """End the current `wait`, for something urgent; any thread may call it."""
        self._bell.ring()

    def doze(self, until: float) -> float:
        """Wait until `until` [s], or until `hurry`; return the time [s]."""
        self.wait(until)
        return self.now()

    def wait(self, until: float) -> None:
        """Wait until `until` [s], or until `hurry`."""
        self._bell.sleep(max(0.0, (until - self.now()) / self._rate))

    def follow(self, whose: str, robots: float, at: float) -> None:
        """Note that the robot's clock showed `robots` [s] at `at` [s, monotonic]; `whose` is the robot's session.

        A report that is not newer than the last one of that session is ignored.
        """
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
        """Return to `speed` if the robot's clock has not been reported for `SILENCE`."""
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
