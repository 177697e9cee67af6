"""`--imperfections`: a simulated robot that falls short in other ways than lumen.yaml says."""

import argparse
from typing import TYPE_CHECKING

from lumen.errors import UsageError
from lumen.features.simulation.settings import IMPERFECTIONS, PERFECT, Imperfections, only
from lumen.language.diagnostics import did_you_mean

if TYPE_CHECKING:
    from lumen.language.projects import Project
    from lumen.language.stories import Story
    from lumen.run.setup import Setup


def configure_imperfections(parser: argparse.ArgumentParser) -> None:
    """`--imperfections`, for a verb that has a simulated robot."""
    names = ", ".join(IMPERFECTIONS)
    what = f"imperfections of the simulated robot: `none`, or a list of {names} (default: as in lumen.yaml, else all)"
    parser.add_argument("--imperfections", metavar="LIST", help=what)


def imperfections_of(text: str | None) -> Imperfections | None:
    """Those that were named, None where nothing was; raises UsageError for what is none."""
    if text is None:
        return None
    if text == "none":
        return PERFECT
    names = tuple(text.split(","))
    for name in names:
        if name not in IMPERFECTIONS:
            hint = did_you_mean(name, IMPERFECTIONS, "there are")
            raise UsageError(f"--imperfections has no `{name}`: {hint}")
    return only(names)


def set_up_robot(options: argparse.Namespace, project: "Project", story: "Story | None") -> "Setup":
    """The robot that the options of `lumen run` ask for; raises UsageError where they do not go together."""
    from lumen.run.setup import robot_options, set_up  # only who has a robot waits for it

    lacking = imperfections_of(options.imperfections)
    if lacking and options.robot != "simulation":
        raise UsageError("--imperfections needs the simulated robot: leave out --robot")
    given = {option.name: vars(options)[option.destination] for option in robot_options()}
    named = {name: value for name, value in given.items() if value}
    return set_up(options.robot, project, options.speed, story, lacking, named)
