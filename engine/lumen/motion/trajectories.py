"""Where a motion has every joint at any time.

A track is compiled once into segments, one before each key: polynomials of the time in the segment for `linear`,
`cubic` and `minimum-jerk`, a curve in time and angle for `bezier`. Only Bezier handles can carry a joint beyond its
keys: `cubic` has Fritsch and Butland's tangents (SIAM J. Sci. Stat. Comput. 5, 1984), level at every extreme.
"""

from bisect import bisect_right
from collections.abc import Mapping, Sequence
from typing import NamedTuple

from lumen.language.motions import Interpolation, Keyframe, MotionDefinition
from lumen.motion.segments import Bezier, Polynomial, Segment

_SMOOTH = (Interpolation.CUBIC, Interpolation.BEZIER)


class JointTrack(NamedTuple):
    """One joint's way: `segments[i]` leads to the key at `ends[i]` [s]; after the last it stays at `last` [rad]."""

    joint: str
    first: float
    last: float
    ends: Sequence[float]
    segments: Sequence[Segment]

    def at(self, t: float) -> float:
        if t <= 0.0:
            return self.first
        i = bisect_right(self.ends, t)  # in a key the next segment begins, exactly at its angle
        return self.segments[i].at(t) if i < len(self.segments) else self.last


class Trajectory:
    """A motion compiled for one performance, from the angles `start` [rad] that the joints have when it begins.

    Joints missing in `start` begin in the motion's start posture, or at their first key where it has none.
    """

    def __init__(self, motion: MotionDefinition, start: Mapping[str, float] | None = None) -> None:
        start = {} if start is None else start
        self.motion, self.duration = motion, motion.duration
        self.tracks = tuple(
            track(joint, keys, start.get(joint, motion.origin.get(joint, keys[0].angle)))
            for joint, keys in motion.tracks.items()
            if keys
        )

    def sample(self, t: float) -> dict[str, float]:
        """The angle [rad; a hand 0..1] at `t` [s] of every joint that the motion moves; it stays at either end."""
        return {track.joint: track.at(t) for track in self.tracks}


def sample(motion: MotionDefinition, t: float, start: Mapping[str, float] | None = None) -> dict[str, float]:
    """One sample of `Trajectory(motion, start)`; who needs many of them keeps the Trajectory."""
    return Trajectory(motion, start).sample(t)


def track(joint: str, keys: Sequence[Keyframe], start: float) -> JointTrack:
    """The track through `keys` from the angle `start` [rad] at time 0."""
    points = [Keyframe(0.0, start, keys[0].interpolation), *keys]
    slopes = _slopes(points)
    segments = [
        _segment(a, b, slope_a, slope_b)
        for a, b, slope_a, slope_b in zip(points, points[1:], slopes, slopes[1:], strict=False)
    ]
    return JointTrack(joint, start, keys[-1].angle, [key.time for key in keys], segments)


def _segment(a: Keyframe, b: Keyframe, slope_a: float, slope_b: float) -> Segment:
    h, d = b.time - a.time, b.angle - a.angle
    match b.interpolation:
        case Interpolation.LINEAR:
            return Polynomial(a.time, h, a.angle, d)
        case Interpolation.MINIMUM_JERK:  # Flash and Hogan, J. Neurosci. 5, 1985: at rest in both keys
            return Polynomial(a.time, h, a.angle, 0.0, 0.0, 10 * d, -15 * d, 6 * d)
        case Interpolation.CUBIC:
            return _hermite(a, h, d, slope_a, slope_b)
        case Interpolation.BEZIER:
            if not a.handle_out[0] and not b.handle_in[0]:
                return _hermite(a, h, d, slope_a, slope_b)
            dt_out, da_out = _handle(a.handle_out, h, slope_a * h / 3)
            dt_in, da_in = _handle((-b.handle_in[0], b.handle_in[1]), h, -slope_b * h / 3)
            angles = (a.angle, a.angle + da_out, b.angle + da_in, b.angle)
            return Bezier(a.time, h, dt_out / h, 1 - dt_in / h, *angles)


def _hermite(a: Keyframe, h: float, d: float, slope_a: float, slope_b: float) -> Polynomial:
    m0, m1 = h * slope_a, h * slope_b
    return Polynomial(a.time, h, a.angle, m0, 3 * d - 2 * m0 - m1, m0 + m1 - 2 * d)


def _handle(given: tuple[float, float], h: float, automatic: float) -> tuple[float, float]:
    """A handle (time from its key [s], angle [rad]) shortened to the segment, so that time never runs back."""
    dt, da = given
    if dt <= 0.0:
        return h / 3, automatic
    return (dt, da) if dt <= h else (h, da * h / dt)


def _slopes(points: Sequence[Keyframe]) -> list[float]:
    """The speed in which a smooth curve passes each key [rad/s]: 0 at an extreme and beside any other kind."""
    slopes = [0.0] * len(points)
    for i in range(1, len(points) - 1):
        a, b, c = points[i - 1], points[i], points[i + 1]
        if b.interpolation in _SMOOTH and c.interpolation in _SMOOTH:
            before = (b.angle - a.angle) / (b.time - a.time)
            after = (c.angle - b.angle) / (c.time - b.time)
            if before * after > 0.0:
                weight = (1 + (c.time - b.time) / (c.time - a.time)) / 3
                slopes[i] = before * after / (weight * after + (1 - weight) * before)
    return slopes
