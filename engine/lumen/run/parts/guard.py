"""The guard of a robot: if its brain is gone, the robot rests."""

from collections.abc import Callable

from lumen.errors import BusRefusedError
from lumen.language.commands import Rest
from lumen.language.events import Event
from lumen.ports import Robot
from lumen.run.presence import BRAIN, HERE, LEAVES, LOST_AFTER, ROBOT_PART, Peer, Presence, where_it_runs

BRAIN_TIMEOUT = 5.0
"""The time without a sign of life of the brain after which its robot rests [s]."""


class BrainGuard:
    """A watch over the brain that the robot follows.

    After BRAIN_TIMEOUT without a brain, the robot rests; when that brain comes back or another one replaces it,
    `notice` is called with `brain.lost` and the time without a brain [s]. The robot also rests if its own process was
    paused for so long that its brain lost it.
    """

    def __init__(
        self,
        robot: Robot,
        presence: Presence,
        notice: Callable[[Event], None],
        tell: Callable[[str], None],
        clock: Callable[[], float],
    ) -> None:
        self.follows = ""
        """The session of the followed brain; empty if there is none."""
        self._robot, self._presence, self._notice, self._tell, self._clock = robot, presence, notice, tell, clock
        self._last: float | None = None
        self._resting = False
        self._ticked, self._woke = clock(), 0.0

    def tick(self, now: float) -> None:
        """Check the brain at `now` [s] on the robot's clock.

        Raises BusRefusedError if this process was paused and another one has taken the robot's place.
        """
        at = self._clock()
        if at - self._ticked > LOST_AFTER:
            self._wake(at)
        self._ticked = at
        if self._woke and (other := self._presence.find(ROBOT_PART)):
            raise BusRefusedError(
                f"this robot's process was paused, and {where_it_runs(other)} has replaced it: this process ends"
            )
        followed = self._presence.get(self.follows) if self.follows else None
        if followed and not self._resting:
            self._last = followed.heard
        gone = followed is None or followed.state == LEAVES or at - followed.heard > LOST_AFTER
        if followed and not gone:
            if self._resting:
                self._follow(followed, now)
        elif (brain := self._presence.find(BRAIN)) and brain.state == HERE:
            self._follow(brain, now)
        elif self._last is not None and not self._resting and at - self._last > BRAIN_TIMEOUT:
            self._resting = True
            self._tell(f"rests: its brain has not responded for {BRAIN_TIMEOUT:g} s")
            self._robot.start("guard", Rest())

    def _wake(self, at: float) -> None:
        """Make the robot rest after a pause of its process, because its commands are out of date."""
        self._woke = at
        if self.follows:
            self._tell(f"rests: its process was paused for {at - self._ticked:.1f} s")
            self._robot.start("guard", Rest())

    def _follow(self, brain: Peer, now: float) -> None:
        if self.follows != brain.session or self._resting:
            self._tell(f"follows the brain in {where_it_runs(brain)}")
        if self._resting and self._last is not None:
            self._notice(Event("brain.lost", {"seconds": round(self._clock() - self._last, 3)}, now))
        self.follows, self._resting = brain.session, False
