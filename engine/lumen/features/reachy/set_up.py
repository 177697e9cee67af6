"""Sets up a Reachy Mini for a run."""

from pathlib import Path

from lumen.clock.real import RealClock
from lumen.errors import UsageError
from lumen.features.reachy.robot import ReachyRobot
from lumen.language.stories import Visitor
from lumen.run.setup import RobotRequest, Setup

ADDRESS = "http://reachy-mini.local:8000"


class TypedVisitors:
    """A `Hall` of real visitors: a person who types is heard, but seen only by a visual module."""

    def place(self, visitor: Visitor | None) -> None:
        """Do nothing: real visitors place themselves."""

    def face(self) -> tuple[float, float] | None:
        """Return None, because only a visual module sees faces."""
        return None


def set_up(request: RobotRequest) -> Setup:
    """Return the setup of the robot whose daemon is at the address in the option `url`, or at ADDRESS without one.

    Raises UsageError for a story or a speed other than 1, and RobotError if there is no such robot.
    """
    if request.speed != "1":
        raise UsageError("a real robot runs in real time: leave out --speed")
    if request.story:
        raise UsageError("a story needs a simulated visitor: leave out --robot reachy")
    project, clock = request.project, RealClock()
    language = project.languages[0] if project.languages else "en"
    robot = ReachyRobot(
        project.body,
        request.options.get("url", ADDRESS),
        clock.now,
        voice=request.options.get("voice", "espeak"),
        language=language,
        root=Path(project.root),
    )
    return Setup(robot, clock, TypedVisitors())
