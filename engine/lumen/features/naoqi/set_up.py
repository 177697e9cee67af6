"""Sets up a real robot with NAOqi."""

from collections.abc import Mapping

from lumen.clock.real import RealClock
from lumen.errors import UsageError
from lumen.features.naoqi.offers import NaoqiRobot, PhysicalHall
from lumen.run.setup import RobotRequest, Setup

NAO = "nao.local"


def set_up(request: RobotRequest) -> Setup:
    """Return the robot at the address in the option `url`, with its clock and its hall.

    Raises UsageError for a story or a speed other than 1, and RobotError if no suitable robot answers.
    """
    if request.speed != "1":
        raise UsageError("a real robot runs in real time: leave out --speed")
    if request.story:
        raise UsageError("a story needs a simulated visitor: leave out --robot naoqi")
    project, clock = request.project, RealClock()
    url = request.options.get("url", NAO)
    return Setup(NaoqiRobot(project.body, url, clock.now, stage=project.stage), clock, PhysicalHall())


def set_up_house(requests: Mapping[str, RobotRequest]) -> dict[str, Setup]:
    """Raise UsageError, because a process can connect to only one real robot."""
    raise UsageError("each real robot needs its own process: pass `--robot-name NAME` and `--robot-url URL`")
