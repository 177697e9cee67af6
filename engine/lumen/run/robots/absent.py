"""An exhibition without a robot."""

from lumen.clock.real import RealClock
from lumen.errors import UsageError
from lumen.robot.none import NoRobot
from lumen.run.setup import RobotRequest, Setup


def set_up(request: RobotRequest) -> Setup:
    """Return a robot that performs nothing, in real time. Raises UsageError for any speed but `1`."""
    if request.speed != "1":
        raise UsageError("without a robot there is nothing to simulate: leave out --speed")
    return Setup(NoRobot(), RealClock(), None)
