"""The commands to the recording robot in one visit of each frozen project: a quick part of `robot_commands`."""

from pathlib import Path

import lumen
from tests.golden.golden import PROJECTS
from tests.golden.subjects.robot_commands import lines
from tests.golden.texts import write

SUITE = "test"
STORIES = {"minimal": "visitor", "museum": "german", "tour": "visitor"}


def record(folder: Path) -> None:
    """Write a file for each visit."""
    for name, story in STORIES.items():
        write(folder / f"{name}.txt", lines(lumen.load(PROJECTS / name), story))
