"""Joint curves of any origin."""

from collections.abc import Collection, Mapping
from typing import NamedTuple

from lumen.language.diagnostics import Place

MAX_NUMBER = 1e12
"""No time and no angle of a motion is as large."""
BezierHandle = tuple[float, float]


class CurvePoint(NamedTuple):
    """At `time` [s] a joint stands at `angle` [rad; a hand 0..1]; come to along a line where it is `straight`.

    Handles are (dt [s], da [rad]) as in `lumen.language.motions.Keyframe`; those with dt = 0 are to be chosen.
    """

    time: float
    angle: float
    place: Place
    straight: bool = False
    handle_in: BezierHandle = (0.0, 0.0)
    handle_out: BezierHandle = (0.0, 0.0)


class MotionFile(NamedTuple):
    """A file of another tool. `timeline` names one of several motions in it; `hands` are joints that open and close."""

    name: str
    content: bytes
    timeline: str = ""
    hands: Collection[str] = ()


JointCurves = Mapping[str, list[CurvePoint]]
"""For each joint its points, in the order of the file."""


def number(text: str) -> float | None:
    """The number that a text holds, None where it holds none, or none that a time or an angle could be."""
    try:
        value = float(text)
    except ValueError:
        return None
    return value if abs(value) < MAX_NUMBER else None
