"""The robot of an exhibition with its clock and the hall around it, chosen by name."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

from lumen.clock.checked import checked_clock
from lumen.clock.real import RealClock
from lumen.clock.simulated import SimulatedClock
from lumen.errors import LumenError, UsageError
from lumen.feature import Feature, RobotOption, RobotRow, distribution_of, owner, table
from lumen.language.diagnostics import did_you_mean
from lumen.language.projects import Project
from lumen.language.stories import Story
from lumen.ports import Advances, Clock, Dozes, Hall, MeasuresPace, Robot
from lumen.project.broken_features import called, faulty, need_made, shown
from lumen.project.main_file import main_settings
from lumen.robot.bounded_robot import BoundedRobot, ability
from lumen.robot.checked_robot import CheckedRobot
from lumen.run.driver import drivers_in, fault_of, is_driver, make_robot
from lumen.run.tracking import TrackingService

SPEEDS = ("1", "4", "max")
NO_OPTIONS: Mapping[str, str] = {}


@dataclass(frozen=True)
class Setup:
    """A robot with its clock and its hall."""

    robot: Robot
    clock: Clock
    hall: Hall | None
    """The simulated world around the robot; None in the real world."""
    blind: str = ""
    """Why the robot's camera has no images, with advice; empty if it has images."""
    remote: bool = False
    """Whether the robot's server is in another process."""
    tracking: TrackingService | None = None
    """Lets controllers follow sightings; None if the exhibition does so itself."""

    def hurry(self) -> None:
        """End the clock's current wait, if the clock can, for an urgent task."""
        if isinstance(self.clock, Dozes):
            self.clock.hurry()


@dataclass(frozen=True)
class RobotRequest:
    """A request for a robot."""

    project: Project
    speed: str
    """One of `SPEEDS`."""
    story: Story | None = None
    options: Mapping[str, str] = field(default_factory=dict)
    """The given options of the robot's row, by name."""
    real_skills: bool = False
    """Whether a recording robot runs the code of added verbs."""

    @property
    def pace(self) -> float | None:
        """The multiple of real time; None for as fast as possible."""
        return None if self.speed == "max" else float(self.speed)


def set_up(
    kind: str,
    project: Project,
    speed: str,
    story: Story | None = None,
    options: Mapping[str, str] = NO_OPTIONS,
    *,
    real_skills: bool = False,
) -> Setup:
    """Return the robot of a name, on its feet; `options` are the given options of the robot's row.

    With `real_skills` the recording robot runs the code of added verbs. Raises UsageError if there is no such robot
    here, or the options do not apply to it; RobotError if it can't be reached, or its driver can't be used; LumenError
    with the name of the installed package if the robot's code is faulty.
    """
    request = RobotRequest(project, speed, story, options, real_skills)
    if _is_own(kind, project):
        return _driven(kind, request)
    return _alone(kind, _row(kind, options), request)


def set_up_house(
    kind: str,
    projects: Mapping[str, Project],
    speed: str,
    stories: Mapping[str, Story | None],
    options: Mapping[str, str] = NO_OPTIONS,
) -> dict[str, Setup]:
    """Return several robots of a kind, on their feet, by the names of their projects.

    Raises the errors of `set_up`, and UsageError if there can't be several.
    """
    requests = {n: RobotRequest(project, speed, stories[n], options) for n, project in projects.items()}
    if all(_is_own(kind, project) for project in projects.values()):
        return {name: _driven(kind, request) for name, request in requests.items()}
    row = _row(kind, options)
    if row.set_up_house:
        feature = owner("robots", kind)
        setups: dict[str, Setup] = called(feature, row.set_up_house, requests)
        if not isinstance(setups, Mapping) or setups.keys() != requests.keys():
            what = f"{shown(setups)} instead of a Setup for each robot's name"
            raise faulty(feature, f"`{row.set_up_house}` returned {what}")
        for setup in setups.values():
            _check(feature, row.set_up_house, setup)
        return {name: _bounded(kind, row, setup, projects[name]) for name, setup in setups.items()}
    return {name: _alone(kind, row, request) for name, request in requests.items()}


def robot_kind(wanted: str, root: Path) -> str:
    """Return the robot's name: the `wanted` one, else the driver of lumen.yaml, else `simulation`.

    Raises UsageError if no robot or driver has the wanted name.
    """
    if not wanted:
        settings = main_settings(root)
        own = settings.robots.get(settings.robot) if settings else None
        return own.driver if own and own.driver else "simulation"
    if wanted not in table("robots") and not is_driver(wanted, root):
        known = (*robot_names(), *drivers_in(root))
        raise UsageError(f"invalid `--robot {wanted}`: {did_you_mean(wanted, known, 'choose one of')}")
    return wanted


def _is_own(kind: str, project: Project) -> bool:
    """Return whether a name is a driver of the project's own."""
    return kind not in table("robots") and is_driver(kind, Path(project.root))


def _driven(driver: str, request: RobotRequest) -> Setup:
    """Return the robot of a driver, kept within the limits and speeds of the project's body."""
    robot, body = make_robot(driver, request.project), request.project.body
    return set_up_with(BoundedRobot(robot, body, fault_of(driver)), None, request.pace)


def _alone(kind: str, row: RobotRow, request: RobotRequest) -> Setup:
    feature = owner("robots", kind)
    setup: Setup = called(feature, row.set_up, request)
    _check(feature, row.set_up, setup)
    return _bounded(kind, row, setup, request.project)


def _check(feature: Feature, where: str, setup: Setup) -> None:
    """Raise LumenError if a robot's function returned no setup, or objects that lack a method."""
    if not isinstance(setup, Setup):
        raise faulty(feature, f"`{where}` returned {shown(setup)} instead of a `lumen.run.setup.Setup`")
    need_made(feature, where, setup.robot, Robot, "a robot")
    need_made(feature, where, setup.clock, Clock, "a clock")
    if setup.hall is not None:
        need_made(feature, where, setup.hall, Hall, "a hall")


def _bounded(kind: str, row: RobotRow, setup: Setup, project: Project) -> Setup:
    """Return a setup whose robot keeps within its body's limits; a package's robot and clock are checked, too."""
    feature = owner("robots", kind)

    def fault(what: str) -> LumenError:
        return faulty(feature, f"its robot `{kind}` {what}")

    if distribution_of(feature):
        clock = checked_clock(setup.clock, lambda what: faulty(feature, f"the clock of its robot `{kind}` {what}"))
        setup = replace(setup, clock=clock)
    if not row.bounded:
        return replace(setup, robot=BoundedRobot(setup.robot, project.body, fault))
    return replace(setup, robot=CheckedRobot(setup.robot, fault)) if distribution_of(feature) else setup


def robot_names() -> tuple[str, ...]:
    """Return the names of the robots that come with Lumen or an installed package, without a project's drivers."""
    return tuple(table("robots"))


def runs_in_real_time(kind: str) -> bool:
    """Return whether a robot's time can't run faster than real time."""
    robots: Mapping[str, RobotRow] = table("robots")
    return kind in robots and robots[kind].real_time


def robot_options() -> tuple[RobotOption, ...]:
    """Return the options of all robots, each name once; the help of an option joins that of all robots that have it."""
    found: dict[str, RobotOption] = {}
    for row in table("robots").values():
        for option in row.options:
            first = found.get(option.name)
            found[option.name] = first._replace(help=f"{first.help}; {option.help}") if first else option
    return tuple(found.values())


def _row(kind: str, options: Mapping[str, str] = NO_OPTIONS) -> RobotRow:
    robots: Mapping[str, RobotRow] = table("robots")
    taken = {option.name for option in robots[kind].options} if kind in robots else set()
    for option in robot_options():
        if option.name in options and option.name not in taken:
            takers = [name for name, row in robots.items() if any(each.name == option.name for each in row.options)]
            raise UsageError(f"{option.flag} needs --robot {' or '.join(takers)}")
    if kind not in robots or not robots[kind].set_up:
        raise UsageError(f"no robot `{kind}`: there are {', '.join(robots)}")
    return robots[kind]


def set_up_with(robot: Robot, clock: Clock | None = None, pace: float | None = None) -> Setup:
    """Return a setup of a given robot, on `clock` or by default on its own time, at `pace` times real time at most.

    A robot that can `advance` is advanced by the time that passes; any other runs in real time. With `pace` None an
    advancing robot runs as fast as possible. A robot with the methods of a `Hall` is its own hall.
    """
    hall = ability(robot, Hall)
    living = ability(robot, Advances)
    advance = living.advance if living else None
    if clock is None:
        return Setup(robot, SimulatedClock(advance, pace) if advance else RealClock(), hall)
    return Setup(robot, _DrivenClock(clock, advance) if advance else clock, hall)


class _DrivenClock:
    """A given clock that also advances a simulated world."""

    def __init__(self, clock: Clock, live: Callable[[float], None]) -> None:
        self._clock, self._live, self._lived = clock, live, clock.now()

    @property
    def realtime(self) -> float:
        """The share of its nominal speed that the clock reaches; 1 if unknown."""
        return self._clock.realtime if isinstance(self._clock, MeasuresPace) else 1.0

    def now(self) -> float:
        """Return the clock's time [s]."""
        return self._clock.now()

    def wait(self, until: float) -> None:
        """Wait until a time [s], and advance the world by all time since the last wait."""
        self._clock.wait(until)
        lived, self._lived = self._lived, self._clock.now()
        self._live(self._lived - lived)
