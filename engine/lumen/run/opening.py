"""An exhibition for other programs: `lumen.open`."""

from pathlib import Path

from lumen.errors import UsageError
from lumen.language.projects import Project
from lumen.language.stories import Story
from lumen.ports import Bus, Clock, Robot
from lumen.project import load
from lumen.robot.bounded_robot import BoundedRobot
from lumen.run.chosen_stories import stories_of
from lumen.run.exhibition import Exhibition
from lumen.run.plan import Plan
from lumen.run.setup import Setup, runs_in_real_time, set_up, set_up_with
from lumen.upkeep.arguments import need_methods


def open(
    path: str | Path | None = None,
    *,
    robot: str | Robot = "recording",
    bus: str | Bus = "memory://",
    clock: Clock | None = None,
    speed: str | float = "max",
    story: str | None = None,
    language: str = "",
) -> Exhibition:
    """Open and start the exhibition of a project; `path` is its folder, by default the project here or above.

    `robot` is the name of a robot, such as `recording`, `simulation`, `naoqi` or `none`, or an object
    (`lumen.ports.Robot`); `bus` is an address (`memory://`, `amqp://…`) or an open bus, which the exhibition closes.
    Time is that of `clock`, or else of the robot's world, at `speed` times real time or as fast as possible (`max`).
    `story` is a scripted visitor. `language` is the language that the robot speaks first, by default the project's. Use
    the result in a `with` block, or `close` it.

    Raises UsageError for an unknown name, several matching stories, an invalid speed, an object that lacks a method, or
    a robot that another process on the bus already is; ProjectError for files with errors, BusError and RobotError if
    the bus or the robot can't be reached.
    """
    if not isinstance(bus, str):
        need_methods(bus, Bus, "a bus")
    if clock is not None:
        need_methods(clock, Clock, "a clock")
    project = load(path)
    found = None
    if story is not None:
        named = list(stories_of(project, story))
        if len(named) > 1:
            raise UsageError(
                f"choose one story: `{story}` matches {len(named)}, such as `{named[0].name}` and `{named[1].name}`"
            )
        found = named[0]
    setup = _setup(project, robot, clock, str(speed), found)
    try:
        exhibition = Exhibition(Plan(project, setup, bus, found, language=language, options={"reload": "off"}))
    except BaseException:
        setup.robot.close()
        raise
    try:
        exhibition.start()
    except BaseException:
        exhibition.close()
        raise
    return exhibition


def _setup(project: Project, robot: str | Robot, clock: Clock | None, speed: str, story: Story | None) -> Setup:
    try:
        pace = None if speed == "max" else float(speed)
    except ValueError:
        raise UsageError(f'`speed` must be a multiple of real time or "max", not `{speed}`') from None
    if not isinstance(robot, str):
        need_methods(robot, Robot, "a robot")
        return set_up_with(BoundedRobot(robot, project.body), clock, pace)
    hurried = "1" if speed == "max" and runs_in_real_time(robot) else speed
    setup = set_up(robot, project, hurried, story)
    return setup if clock is None else set_up_with(setup.robot, clock)
