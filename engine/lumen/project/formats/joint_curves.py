"""Joint curves that an importer has read."""

from collections.abc import Collection, Mapping
from typing import NamedTuple

from lumen.language.diagnostics import Place

MAX_NUMBER = 1e12
"""An upper bound of all times and angles in a motion; larger numbers are refused."""
BezierHandle = tuple[float, float]


class CurvePoint(NamedTuple):
    """A point of a joint's curve."""

    time: float
    """When the joint is at `angle` [s]."""
    angle: float
    """The joint's angle [rad]; the opening of a hand, 0 to 1."""
    place: Place
    straight: bool = False
    """True if the curve to this point is a straight line."""
    handle_in: BezierHandle = (0.0, 0.0)
    """A handle (dt [s], da [rad]) as in `lumen.language.motions.Keyframe`; if dt is 0, Lumen chooses the handle."""
    handle_out: BezierHandle = (0.0, 0.0)


class MotionFile(NamedTuple):
    """A file of another tool that holds motions."""

    name: str
    content: bytes
    timeline: str = ""
    """The name of one of several motions in the file."""
    hands: Collection[str] = ()
    """The joints that open and close: their values are openings, 0 to 1, instead of angles."""


JointCurves = Mapping[str, list[CurvePoint]]
"""The points of each joint, in the order of the file."""


def number(text: str) -> float | None:
    """Return the number that a text holds; None if it holds none, or one that is too large for a time or an angle."""
    try:
        value = float(text)
    except ValueError:
        return None
    return value if abs(value) < MAX_NUMBER else None
