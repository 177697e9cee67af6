"""The commands to the recording robot in each story of the frozen projects, with their times."""

from pathlib import Path

import lumen
from tests.golden.adapters import robot_commands
from tests.golden.golden import PROJECTS
from tests.golden.texts import in_one_line, write

SUITE = "rest"


def record(folder: Path) -> None:
    """Write a file for each story: a line for each command."""
    for root in sorted(PROJECTS.iterdir()):
        project = lumen.load(root)
        for story in sorted(project.stories):
            write(folder / root.name / f"{story}.txt", lines(project, story))


def lines(project: lumen.Project, story: str) -> list[str]:
    """Return the commands of a story: time [s], verb, id and command."""
    told = robot_commands(project, story)
    return [f"{time:.3f} {verb} {id or '-'} {in_one_line(command)}" for time, verb, id, command in told]
