"""How each style of life moves the joints at 50 Hz, in virtual time and without physics.

The robot hears a sound at 5 s, speaks at 10 s, has its head led at 18 s and touched at 24 s; a command has its head
from 26 s to 28 s. The lines are those of `motion_angles`.
"""

from pathlib import Path

import lumen
from tests.golden.adapters import alive
from tests.golden.golden import PROJECTS
from tests.golden.subjects.motion_angles import angles
from tests.golden.texts import write

SUITE = "test"
SECONDS = 40


def record(folder: Path) -> None:
    """Write a file for each style."""
    for root in sorted(PROJECTS.iterdir()):
        project = lumen.load(root)
        for style in sorted(project.life):
            write(folder / root.name / f"{style}.txt", angles(list(alive(project, style, SECONDS))))
