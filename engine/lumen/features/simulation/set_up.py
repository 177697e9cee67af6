"""Set up one simulated robot, or several in one hall, which can see and push each other."""

from collections.abc import Mapping
from math import cos, sin
from pathlib import Path
from typing import NamedTuple

from lumen.clock.simulated import SimulatedClock
from lumen.features.simulation.model import compile_world, place, read_hall
from lumen.features.simulation.model_terms import ROBOT_PREFIX, STAGE_SITE
from lumen.features.simulation.offers import SimulatedRobot, available
from lumen.features.simulation.options import imperfections_of
from lumen.features.simulation.physics import Physics, wrapper
from lumen.features.simulation.settings import Imperfections
from lumen.features.simulation.visitor_figure import VisitorFigure
from lumen.features.simulation.world import CONTROL_PERIOD, World
from lumen.language.house import StartPose
from lumen.language.projects import Stage
from lumen.language.robots import Body
from lumen.project.lending import model_files
from lumen.run.setup import RobotRequest, Setup


class HallRobot(NamedTuple):
    """The settings of one robot in a shared hall."""

    body: Body
    models: Path
    """The folder of the robot's MJCF."""
    at: StartPose = StartPose()
    """The robot's pose in the hall at the start."""
    imperfections: Imperfections = Imperfections()
    stage: Stage | None = None
    """The area in which the robot may move; None for no bounds."""


class SharedHall:
    """Robots, by name, in one hall, whose time passes only in `advance`, in the caller's thread.

    `models` is the folder of the hall's MJCF. The hall has one visitor, whom all robots can see and any robot's `place`
    moves. Raises RobotError if the models are unusable.
    """

    def __init__(self, robots: Mapping[str, HallRobot], models: Path, hall: str, *, posture: str = "Stand") -> None:
        prefixes = {name: f"{ROBOT_PREFIX}{i + 1 if i else ''}" for i, name in enumerate(robots)}
        physics = _physics(robots, prefixes, models, hall)
        worlds = {
            name: World(
                each.body, models, hall, backlash=each.imperfections.backlash, shared=physics, prefix=prefixes[name]
            )
            for name, each in robots.items()
        }
        for name, world in worlds.items():
            world.set_up(robots[name].body.postures[posture])
        first = next(iter(worlds.values()))
        self.world, self.figure = first, VisitorFigure(first.model, first.data)
        self.robots = {
            name: SimulatedRobot(
                each.body, each.models, hall, seed=seed, posture=posture, imperfections=each.imperfections,
                stage=each.stage, world=worlds[name], figure=self.figure,
            )
            for seed, (name, each) in enumerate(robots.items())
        }  # fmt: skip
        self._ticks, self._until = 0, 0.0

    def advance(self, dt: float) -> None:
        """Advance by `dt` [s] in whole control periods; the remainder is kept for the next call.

        Raises RobotError if the models make the simulation unstable.
        """
        self._until += dt
        while (self._ticks + 1) * CONTROL_PERIOD <= self._until + 1e-9:
            for robot in self.robots.values():
                robot.act()
            self.world.step()
            for robot in self.robots.values():
                robot.feel()
            self._ticks += 1


def _physics(robots: Mapping[str, HallRobot], prefixes: Mapping[str, str], models: Path, hall: str) -> Physics:
    world = read_hall(models, hall)
    stage = world.find("site", STAGE_SITE)
    x, y, z = stage.pos if stage.pos is not None else (0.0, 0.0, 0.0)
    for name, each in robots.items():
        half = each.at.facing / 2
        site = world.worldbody.add(
            "site",
            name=f"{STAGE_SITE}-{prefixes[name]}",
            pos=(x + each.at.x, y + each.at.y, z),
            quat=(cos(half), 0.0, 0.0, sin(half)),
        )
        place(world, hall, each.body, each.models, site, backlash=each.imperfections.backlash, prefix=prefixes[name])
    return Physics.from_model(wrapper.MjModel(compile_world(world)))


def set_up(request: RobotRequest) -> Setup:
    """Return a standing robot with a simulated clock. Raises RobotError if the models are unusable."""
    project = request.project
    robot = SimulatedRobot(project.body, *model_files(project), imperfections=lacking_in(request), stage=project.stage)
    return Setup(robot, SimulatedClock(robot.advance, request.pace), robot, available() or "")


def set_up_house(requests: Mapping[str, RobotRequest]) -> dict[str, Setup]:
    """Return standing robots in one hall with one shared clock. Raises RobotError if the models are unusable."""

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
    """Return a robot's imperfections, from `--imperfections` if given, else from the project.

    Raises UsageError if the option has an unknown name.
    """
    return imperfections_of(request.options.get("imperfections")) or request.project.section(Imperfections)
