"""Walks: NAOqi's `moveTo` and `move`, while Lumen watches the stage, the sonars and the bumpers."""

from collections.abc import Callable
from math import hypot, isfinite
from typing import Any

from lumen.errors import BadCommandError, RobotError, RobotFailedError, RobotRefusedError
from lumen.features.naoqi.call_sequence import CallSequence, CallSteps, WhileWaiting
from lumen.features.naoqi.session import NaoqiCall
from lumen.features.naoqi.walking_area import MAX_STAGE_DRIFT, GroundPose, WalkingArea
from lumen.language.commands import Move, Walk

MAX_WALK_DISTANCE = 10.0
"""The longest walk that is accepted [m]."""
ARRIVAL_TOLERANCE, HEADING_TOLERANCE = 0.1, 0.2
"""The deviations in distance [m] and heading [rad] above which a walk has failed, if NAOqi reports no result."""
POSITION_CHECK_PERIOD = 0.2
"""The time between two checks of the robot's position [s]."""
SITTING_FAMILIES = ("Sitting", "SittingOnChair", "Belly", "Back", "Left", "Right", "UpsideDown", "Kneeling", "Lifted")
"""NAOqi's posture families from which the robot can't walk, besides those that begin with `Lying`."""

PostCall = Callable[..., NaoqiCall]


def grounded(family: object) -> bool:
    """Return whether the robot is off its feet or wheels, by its posture family."""
    return str(family) in SITTING_FAMILIES or str(family).startswith("Lying")


class WalkMonitor:
    """Checks for hazards during a walk, and stops the robot at the first; `reason` describes it, else it is empty."""

    def __init__(self, post: PostCall, area: WalkingArea, here: GroundPose) -> None:
        self.reason = ""
        self._post, self._area, self._here = post, area, here
        self._where: NaoqiCall | None = None
        self._look = 0.0

    def __call__(self, now: float) -> None:
        if self.reason:
            return
        self.reason = self._area.danger() or self._astray(now)
        if self.reason:
            self._post("ALMotion", "stopMove")

    def _astray(self, now: float) -> str:
        """Return why the robot must not continue from its present position.

        Return an empty string if it can continue, or while NAOqi has not answered.
        """
        if self._where is None:
            if now >= self._look:
                self._where, self._look = self._post("ALMotion", "getRobotPosition", True), now + POSITION_CHECK_PERIOD
            return ""
        if not self._where.done:
            return ""
        found, self._where = self._where, None
        try:
            return self._area.outside(found.result(), self._here, MAX_STAGE_DRIFT)
        except RobotError as error:
            return f"the position of the robot is unknown ({error})"


class NaoqiWalks:
    """Begins walks; `post` calls NAOqi."""

    def __init__(self, post: PostCall, area: WalkingArea) -> None:
        self._post, self._area = post, area

    def begin(self, command: Walk | Move) -> CallSequence:
        """Return the activity of a walk.

        Raises RobotError before any movement if the walk is invalid or a hazard is near.
        """
        numbers = (
            (command.x, command.y, command.theta)
            if isinstance(command, Walk)
            else (command.vx, command.vy, command.vtheta)
        )
        if not all(map(isfinite, numbers)):
            raise BadCommandError(f"there is no way to {numbers}")
        if isinstance(command, Walk) and hypot(command.x, command.y) > MAX_WALK_DISTANCE:
            raise BadCommandError(f"({command.x:g}, {command.y:g}) is too far: walk at most {MAX_WALK_DISTANCE:g} m")
        if reason := self._area.danger():
            raise RobotRefusedError(f"{reason}: the robot did not start walking")
        doing = self._walk(numbers) if isinstance(command, Walk) else self._move(numbers)
        return CallSequence(doing, lambda: [self._post("ALMotion", "stopMove")])

    def _standing(self) -> CallSteps:
        """Return the robot's position. Raises RobotRefusedError if it is not upright or its motors are off."""
        family = yield self._post("ALRobotPosture", "getPostureFamily")
        if grounded(family):
            raise RobotRefusedError(f"the robot is {family}: send it to Stand first")
        if not (yield self._post("ALMotion", "robotIsWakeUp")):
            raise RobotRefusedError("the motors are off: `wake` first")
        here = yield self._post("ALMotion", "getRobotPosition", True)
        self._area.meet(here)
        return here

    def _walk(self, way: tuple[float, float, float]) -> CallSteps:
        here = yield from self._standing()
        self._area.check_way(here, way)
        watch = WalkMonitor(self._post, self._area, here)
        arrived = yield WhileWaiting(self._post("ALMotion", "moveTo", *map(float, way)), watch)
        if watch.reason:
            raise RobotFailedError(f"{watch.reason}: the walk was stopped")
        if arrived is None:
            arrived = yield from self._arrived(here, way)
        if not arrived:
            raise RobotFailedError("the robot stopped before it arrived: something is in its way")

    def _arrived(self, here: GroundPose, way: tuple[float, float, float]) -> CallSteps:
        """Return whether the robot is at its goal by odometry; NAOqi 2.1's `moveTo` does not report this."""
        there = yield self._post("ALMotion", "getRobotPosition", True)
        went, turned = hypot(there[0] - here[0], there[1] - here[1]), there[2] - here[2]
        return abs(went - hypot(*way[:2])) <= ARRIVAL_TOLERANCE and abs(turned - way[2]) <= HEADING_TOLERANCE

    def _move(self, velocity: tuple[float, float, float]) -> CallSteps:
        here = yield from self._standing()
        watch = WalkMonitor(self._post, self._area, here)
        yield self._post("ALMotion", "move", *map(float, velocity))
        while any(velocity):
            now: Any = yield None
            watch(now)
            if watch.reason:
                yield self._post("ALMotion", "stopMove")
                raise RobotFailedError(f"{watch.reason}: the walk was stopped")
