"""Robots under physics."""

from collections.abc import Mapping

from lumen.clock.simulated import SimulatedClock
from lumen.features.simulation.offers import SimulatedRobot, available
from lumen.project.lending import model_files
from lumen.run.setup import RobotRequest, Setup


def set_up(request: RobotRequest) -> Setup:
    """Return a robot on its feet, in the simulation's time."""
    project = request.project
    robot = SimulatedRobot(project.body, *model_files(project), imperfections=request.lacking, stage=project.stage)
    return Setup(robot, SimulatedClock(robot.advance, request.pace), robot, available() or "")


def set_up_house(requests: Mapping[str, RobotRequest]) -> dict[str, Setup]:
    """Return robots on their feet in one hall, with one clock."""
    from lumen.features.simulation.shared_hall import HallRobot, SharedHall

    robots = {
        name: HallRobot(
            request.project.body,
            model_files(request.project)[0],
            request.project.robots[name].at,
            request.lacking,
            request.project.stage,
        )
        for name, request in requests.items()
    }
    first = next(iter(requests.values()))
    shared = SharedHall(robots, *model_files(first.project))
    clock, blind = SimulatedClock(shared.advance, first.pace), available() or ""
    return {name: Setup(robot, clock, robot, blind) for name, robot in shared.robots.items()}
