"""Convert durations, angles and lengths as people write them to SI."""

from collections.abc import Mapping
from math import pi
from typing import Any, NamedTuple

from lumen.language.diagnostics import ERROR, Code
from lumen.language.durations import seconds
from lumen.language.robots import Body

__all__ = ["ANGLES", "BAD_DURATION", "LENGTHS", "JointUnits", "joint_units", "seconds", "unit_in_si"]

BAD_DURATION = Code("bad-duration", "shape", ERROR, "a duration can't be read")


ANGLES: Mapping[str, float] = {"rad": 1.0, "deg": pi / 180}
LENGTHS: Mapping[str, float] = {"m": 1.0, "cm": 0.01, "mm": 0.001}


class JointUnits(NamedTuple):
    """The names of the units in which a file gives the positions of joints."""

    angle: str = "rad"
    length: str = "m"

    def name(self, joint: str, body: Body) -> str:
        """Return the unit of a joint; empty for a hand, which has an opening from 0 to 1."""
        return "" if joint in body.hands else self.length if joint in body.slides else self.angle

    def factor(self, joint: str, body: Body) -> float:
        """Return one unit of a joint's position in SI: [rad], [m], or 1 for the opening of a hand."""
        return {**ANGLES, **LENGTHS}.get(self.name(joint, body), 1.0)


def joint_units(data: Any) -> JointUnits:
    """Return the units that the `units` of a file name; SI units if the file names none."""
    units = data.get("units") if isinstance(data, Mapping) else None
    given = units if isinstance(units, Mapping) else {}
    return JointUnits(given.get("angle", "rad"), given.get("length", "m"))


def unit_in_si(joint: str, body: Body) -> str:
    """Return the SI unit of a joint's position; empty for a hand."""
    return JointUnits().name(joint, body)
