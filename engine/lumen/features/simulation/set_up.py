"""Sets up robots under physics."""

from collections.abc import Mapping

from lumen.clock.simulated import SimulatedClock
from lumen.features.simulation.offers import SimulatedRobot, available
from lumen.features.simulation.options import imperfections_of
from lumen.features.simulation.settings import Imperfections
from lumen.project.lending import model_files
from lumen.run.setup import RobotRequest, Setup


def set_up(request: RobotRequest) -> Setup:
    """Return a standing robot with a clock of simulated time."""
    project = request.project
    robot = SimulatedRobot(project.body, *model_files(project), imperfections=lacking_in(request), stage=project.stage)
    return Setup(robot, SimulatedClock(robot.advance, request.pace), robot, available() or "")


def set_up_house(requests: Mapping[str, RobotRequest]) -> dict[str, Setup]:
    """Return standing robots in one hall with one shared clock."""
    from lumen.features.simulation.shared_hall import HallRobot, SharedHall

    robots = {
        name: HallRobot(
            request.project.body,
            model_files(request.project)[0],
            request.project.robots[name].at,
            lacking_in(request),
            request.project.stage,
        )
        for name, request in requests.items()
    }
    first = next(iter(requests.values()))
    shared = SharedHall(robots, *model_files(first.project))
    clock, blind = SimulatedClock(shared.advance, first.pace), available() or ""
    return {name: Setup(robot, clock, robot, blind) for name, robot in shared.robots.items()}


def lacking_in(request: RobotRequest) -> Imperfections:
    """Return the imperfections of a robot: those of `--imperfections`, else the project's. Raises UsageError."""
    return imperfections_of(request.options.get("imperfections")) or request.project.section(Imperfections)
