"""Who plays in a house: the robots, each with its clock, and the hall around them."""

from collections.abc import Mapping

from lumen.app.setup import Setup, set_up
from lumen.clocks.simulated import SimulatedClock
from lumen.errors import UsageError
from lumen.language.imperfections import Imperfections
from lumen.language.projects import Project
from lumen.language.stories import Story
from lumen.loading.lending import model_files


def set_up_house(
    kind: str,
    projects: Mapping[str, Project],
    speed: str,
    stories: Mapping[str, Story | None],
    imperfections: Imperfections | None = None,
) -> dict[str, Setup]:
    """The robots of that kind, by name, on their feet; simulated ones stand in one hall and have one clock.

    `imperfections` are other than the project's. Raises UsageError where there can't be several.
    """
    if kind == "naoqi":
        raise UsageError("each real robot needs its own process: pass `--robot-name NAME` and `--robot-url URL`")
    if kind == "simulation":
        return _simulated(projects, None if speed == "max" else float(speed), imperfections)
    return {name: set_up(kind, project, speed, stories[name]) for name, project in projects.items()}


def _simulated(
    projects: Mapping[str, Project], pace: float | None, imperfections: Imperfections | None
) -> dict[str, Setup]:
    from lumen.robots.simulation import available
    from lumen.robots.simulation.shared_hall import HallRobot, SharedHall

    robots = {
        name: HallRobot(
            project.body,
            model_files(project)[0],
            project.robots[name].at,
            imperfections or project.section(Imperfections),
            project.stage,
        )
        for name, project in projects.items()
    }
    shared = SharedHall(robots, *model_files(next(iter(projects.values()))))
    clock, blind = SimulatedClock(shared.advance, pace), available() or ""
    return {name: Setup(robot, clock, robot, blind) for name, robot in shared.robots.items()}
