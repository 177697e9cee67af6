"""The plan of one robot's exhibition, from the options of `lumen run`."""

import argparse
import signal
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

from lumen.cli.run_choices import language_of
from lumen.errors import BusUnreachableError
from lumen.language.projects import Project
from lumen.language.stories import Story
from lumen.ports import Clock
from lumen.project.home import home_of
from lumen.run.compose import compose
from lumen.run.making.modules import ModulesPlan
from lumen.run.narrator import Narrator
from lumen.run.plan import Plan
from lumen.run.recovery.run_directory import RunDirectory
from lumen.run.services import Services
from lumen.run.setup import Setup


@dataclass(frozen=True, slots=True)
class RobotRun:
    """One robot of a run."""

    project: Project
    """The robot's project."""
    directory: RunDirectory
    """The robot's home."""
    story: Story | None
    """The story of the robot's visitor; None without one."""
    first: bool = True
    """True if the person at the terminal plays this robot's visitor, and this robot serves the console."""


def running(made: Sequence[Services], project: Project) -> Project:
    """Return the project that the exhibition in `made` runs now; `project` if the list is still empty."""
    return made[0].project if made else project


def leave(made: Iterable[Services]) -> None:
    """End these exhibitions and keep their state, so that the next run continues from there."""
    for one in made:
        one.node.interrupt(2, leave=True)


def heed_signals(made: Sequence[Services]) -> None:
    """Make Ctrl-C interrupt these exhibitions, and SIGTERM end them; `made` may grow later."""

    def interrupt() -> None:
        for one in made:
            one.node.interrupt()

    signal.signal(signal.SIGINT, lambda *_: interrupt())
    signal.signal(signal.SIGTERM, lambda *_: leave(made))


def bus_hint(options: argparse.Namespace) -> str:
    """Return the end of a message about an unreachable bus: the hint to use the embedded one; empty with `--only`."""
    return "" if options.only else ", or use --bus memory://"


def compose_or_hint(plan: Plan, hint: str) -> Services:
    """Compose an exhibition. Raises the same errors as `compose`; `hint` is added if the bus can't be reached."""
    try:
        return compose(plan)
    except BusUnreachableError as error:
        raise BusUnreachableError(f"{error}{hint}") if hint else error from None


def plan_of(
    options: argparse.Namespace,
    one: RobotRun,
    parts: tuple[str, ...],
    url: str,
    setup: Setup | None,
    clock: Clock,
    narrator: Narrator,
    **more: Any,
) -> Plan:
    """Return the plan of a robot's exhibition, or of these parts of it; `more` are options of the plan.

    Raises UsageError for a language that the project does not have.
    """
    project, directory, played = one.project, one.directory, options.story is not None
    folder = None if played else home_of(directory.root, directory.robot)
    wanted: dict[str, Any] = {
        "directory": directory,
        "operated": True,
        "reload": options.reload,
        "fresh": options.fresh or (played and not parts),
        "alerts": not played,
        "modules": ModulesPlan(folder, awaited=options.speed == "max"),
        "console": one.first and options.speed != "max",
    }
    return Plan(
        project,
        setup,
        url,
        one.story,
        narrator,
        roles=parts,
        clock=clock,
        language=language_of(project, options.language),
        speed=1.0 if options.speed == "max" else float(options.speed),
        options={**wanted, **more},
    )
