"""The angle of each joint in each motion of the frozen projects, at 50 Hz, for each body that has a motion of its own.

A line for each second holds a digest of all fifty moments, and the angles [rad; hands 0..1] at the first of them.
"""

import os
from pathlib import Path
from unittest.mock import patch

import lumen
import lumen.motion
from tests.golden.golden import PROJECTS
from tests.golden.texts import digest, rounded, write

SUITE = "test"
BODIES = {"minimal": ("nao",), "museum": ("nao",), "tour": ("nao", "v6", "pepper", "greeter", "sprout", "lantern")}
RATE = 50
DIGITS = 6


def record(folder: Path) -> None:
    """Write a file for each motion and body."""
    for name, bodies in BODIES.items():
        for body in bodies:
            with patch.dict(os.environ, LUMEN_MODEL=body):
                project = lumen.load(PROJECTS / name)
            for motion, definition in sorted(project.motions.items()):
                trajectory = lumen.motion.Trajectory(definition)
                ticks = range(round(definition.duration * RATE) + RATE)
                write(folder / name / body / f"{motion}.txt", angles([trajectory.sample(t / RATE) for t in ticks]))


def angles(samples: list[dict[str, float]]) -> list[str]:
    """Return a line of the joints' names, then one for each second."""
    joints = sorted({joint for sample in samples for joint in sample})
    rows = [[rounded(sample.get(joint, 0.0), DIGITS) for joint in joints] for sample in samples]
    seconds = range(0, len(rows), RATE)
    return [
        " ".join(["second", "digest", *joints]),
        *(f"{n // RATE} {digest(map(' '.join, rows[n : n + RATE]))} {' '.join(rows[n])}" for n in seconds),
    ]
