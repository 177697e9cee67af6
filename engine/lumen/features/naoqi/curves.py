"""Motions in NAOqi's form: one call of `angleInterpolationBezier` for all joints and keys.

Bezier, cubic and linear tracks are converted exactly, because their segments are cubic curves. A minimum-jerk segment
has degree five. It becomes n cubic pieces with the correct speed at both ends, enough to keep the error below
`MAX_CURVE_ERROR`. For a distance d, the error is at most 360 d / (384 n^4).
"""

from collections.abc import Iterable, Iterator
from math import ceil
from typing import Any, NamedTuple

from lumen.motion.trajectories import Bezier, JointTrack, Polynomial, Segment

MOTION_CYCLE = 0.02
"""The period of ALMotion's control cycle [s]."""
MAX_CURVE_ERROR = 1e-3
"""The maximum deviation of a joint from a minimum-jerk track [rad]."""
MIN_PIECE_DURATION = 2 * MOTION_CYCLE
"""The minimum duration of a piece [s]."""
BEZIER_HANDLE = 3
"""NAOqi's number for an explicit handle."""


class CubicPiece(NamedTuple):
    """A cubic Bezier curve of the given duration [s], whose points have the angles `a0` to `a3` [rad]."""

    start: float
    """The curve's start time [s]."""
    duration: float
    t1: float
    """The time from the curve's start to the first inner point [s]."""
    t2: float
    """The time from the curve's start to the second inner point [s]."""
    a0: float
    a1: float
    a2: float
    a3: float


class BezierCurves(NamedTuple):
    """The three arguments of `angleInterpolationBezier`."""

    names: list[str]
    """The joints' names."""
    times: list[list[float]]
    """The times of each joint's keys [s]."""
    controls: list[list[list[Any]]]
    """The control points of each joint's keys."""


def curves(tracks: Iterable[JointTrack]) -> BezierCurves:
    """Return these tracks in NAOqi's form.

    NAOqi begins each track at the joint's present angle, so the track should begin there too. NAOqi's handle for that
    first point is not documented. Therefore the first key lies on the track one ALMotion cycle later, and the movement
    before that key is too short to be visible.
    """
    found = BezierCurves([], [], [])
    for track in tracks:
        pieces = [piece for segment in track.segments for piece in _pieces(segment)]
        pieces[:1] = _split(pieces[0])
        found.names.append(track.joint)
        found.times.append([piece.start + piece.duration for piece in pieces])
        found.controls.append(list(_controls(pieces)))
    return found


def _controls(pieces: list[CubicPiece]) -> Iterator[list[Any]]:
    for piece, after in zip(pieces, [*pieces[1:], None], strict=True):
        before = [BEZIER_HANDLE, piece.t2 - piece.duration, piece.a2 - piece.a3]
        yield [piece.a3, before, [BEZIER_HANDLE, after.t1, after.a1 - after.a0] if after else [BEZIER_HANDLE, 0.0, 0.0]]


def _pieces(segment: Segment) -> Iterator[CubicPiece]:
    match segment:
        case Bezier(start, h, x1, x2, a0, a1, a2, a3):
            yield CubicPiece(start, h, x1 * h, x2 * h, a0, a1, a2, a3)
        case Polynomial():
            yield from _cubics(segment)


def _cubics(curve: Polynomial) -> Iterator[CubicPiece]:
    """Yield cubic pieces that have the polynomial's angles and speeds at their ends.

    One piece is exact for a polynomial up to the third degree.
    """
    most = max(1, int(curve.duration / MIN_PIECE_DURATION))
    way = abs(curve.c5) / 6
    pieces = min(most, ceil((360 / 384 * way / MAX_CURVE_ERROR) ** 0.25)) if way else 1
    for i in range(max(1, pieces)):
        u0, u1 = i / max(1, pieces), (i + 1) / max(1, pieces)
        h, du = curve.duration * (u1 - u0), u1 - u0
        a0, a3 = curve.at(curve.start + u0 * curve.duration), curve.at(curve.start + u1 * curve.duration)
        a1, a2 = a0 + _slope(curve, u0) * du / 3, a3 - _slope(curve, u1) * du / 3
        yield CubicPiece(curve.start + u0 * curve.duration, h, h / 3, 2 * h / 3, a0, a1, a2, a3)


def _slope(c: Polynomial, u: float) -> float:
    return c.c1 + u * (2 * c.c2 + u * (3 * c.c3 + u * (4 * c.c4 + u * 5 * c.c5)))


def _split(piece: CubicPiece) -> list[CubicPiece]:
    """Return the piece split one ALMotion cycle after its start, by de Casteljau's algorithm; whole if too short."""
    if piece.duration < MIN_PIECE_DURATION:
        return [piece]
    u = _reached(piece, MOTION_CYCLE)
    times = _halves(u, 0.0, piece.t1, piece.t2, piece.duration)
    angles = _halves(u, piece.a0, piece.a1, piece.a2, piece.a3)
    at = times[0][3]
    first = CubicPiece(piece.start, at, times[0][1], times[0][2], *angles[0])
    rest = CubicPiece(piece.start + at, piece.duration - at, times[1][1] - at, times[1][2] - at, *angles[1])
    return [first, rest]


ControlPoints = tuple[float, float, float, float]


def _halves(u: float, p0: float, p1: float, p2: float, p3: float) -> tuple[ControlPoints, ControlPoints]:
    def mix(a: float, b: float) -> float:
        return a + u * (b - a)

    a, b, c = mix(p0, p1), mix(p1, p2), mix(p2, p3)
    d, e = mix(a, b), mix(b, c)
    middle = mix(d, e)
    return (p0, a, d, middle), (middle, e, c, p3)


def _reached(piece: CubicPiece, time: float) -> float:
    """Return the parameter from 0 to 1 at which the curve reaches `time` [s] after its start, by bisection."""
    low, high = 0.0, 1.0
    for _ in range(50):
        u = (low + high) / 2
        if _halves(u, 0.0, piece.t1, piece.t2, piece.duration)[0][3] < time:
            low = u
        else:
            high = u
    return (low + high) / 2
