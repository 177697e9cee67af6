"""A visit in the simulated hall, with physics: the angle of each joint and the position, twice a second.

MuJoCo on another processor may differ in the last bits, and contacts amplify the difference. So no bits are compared: a
number within `TOLERANCE` of the recorded one is written as it was recorded. Commands and their times must be equal.
"""

import shutil
from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import lumen
from tests.golden.adapters import Sense, command_text
from tests.golden.golden import PROJECTS, RECORDED
from tests.golden.texts import in_one_line, rounded, snapped, write

SUITE = "rest"
SECONDS = 20.0
EVERY = 0.5
DIGITS = 3
TOLERANCE = 0.02
"""The greatest accepted difference [rad; hands 0..1; m]."""
NUMBER = r"-?\d+\.\d{3}\b"


def record(folder: Path) -> None:
    """Write commands and angles, for two projects."""
    for name in ("minimal", "tour"):
        with TemporaryDirectory() as temporary:
            lines = list(visit(Path(shutil.copytree(PROJECTS / name, Path(temporary) / name))))
        write(folder / f"{name}.txt", snapped(lines, RECORDED / "simulated_visit" / f"{name}.txt", TOLERANCE, NUMBER))


def visit(root: Path) -> Iterator[str]:
    """Yield the lines of a visit: commands as they are asked for, and angles."""
    told: list[Any] = []
    with lumen.open(root, robot="simulation", story="visitor") as exhibition:
        exhibition.observe(lambda step: told.extend(step.commands))
        names: tuple[str, ...] = ()
        while exhibition.now < SECONDS and not exhibition.over:
            exhibition.run(EVERY)
            yield from (f"{exhibition.now:.2f} s {in_one_line(command_text(command))}" for command in told)
            told.clear()
            joints = exhibition.services.setup.robot.read(Sense.JOINT)
            if not names:
                names = joints.names
                yield " ".join(["time", *names, "x", "y", "theta"])
            place = joints.position
            numbers = [*joints.angles, *((place.x, place.y, place.theta) if place else ())]
            yield " ".join([f"{exhibition.now:.2f} s", *(rounded(number, DIGITS) for number in numbers)])
