"""The angles of all joints of a motion at any time.

A track is compiled once into segments, one before each key: polynomials of the time in the segment for `linear`,
`cubic` and `minimum-jerk`, a curve in time and angle for `bezier`. Only Bezier handles can carry a joint beyond its
keys: `cubic` has Fritsch and Butland's tangents (SIAM J. Sci. Stat. Comput. 5, 1984), level at every extreme.
"""

from bisect import bisect_right
from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import NamedTuple

from lumen.language.motions import Interpolation, Keyframe, MotionDefinition


class Polynomial(NamedTuple):
    """c0 + c1 u + … + c5 u^5 [rad], with u from 0 to 1 between `start` and `start + duration` [s]."""

    start: float
    duration: float
    c0: float
    c1: float
    c2: float = 0.0
    c3: float = 0.0
    c4: float = 0.0
    c5: float = 0.0

    def at(self, t: float) -> float:
        """Return the angle [rad] at `t` [s]."""
        u = (t - self.start) / self.duration
        return self.c0 + u * (self.c1 + u * (self.c2 + u * (self.c3 + u * (self.c4 + u * self.c5))))

    def peak_speed(self) -> float:
        """Return the peak speed in the segment [rad/s]; exact for lines, cubics and minimum jerk."""
        _, duration, _, c1, c2, c3, c4, c5 = self
        first, last = abs(c1), abs(c1 + (2 * c2 + (3 * c3 + (4 * c4 + 5 * c5))))
        fastest = 0.5 if c5 else -c2 / (3 * c3) if c3 else 0.0  # minimum jerk is symmetric, a cubic has a vertex
        inner = abs(self._slope(fastest)) if 0.0 < fastest < 1.0 else first
        return max(first, inner, last) / duration

    def extremes(self) -> tuple[float, float]:
        """Return the smallest and the greatest angle [rad]: those at the ends, which these polynomials never exceed."""
        first, last = self.c0, self.c0 + self.c1 + self.c2 + self.c3 + self.c4 + self.c5
        return min(first, last), max(first, last)

    def _slope(self, u: float) -> float:
        return self.c1 + u * (2 * self.c2 + u * (3 * self.c3 + u * (4 * self.c4 + u * 5 * self.c5)))


class Bezier(NamedTuple):
    """A cubic Bezier curve: `x1` and `x2` place its inner points in time (0 to 1); `a0` to `a3` are angles [rad]."""

    start: float
    duration: float
    x1: float
    x2: float
    a0: float
    a1: float
    a2: float
    a3: float

    def at(self, t: float) -> float:
        """Return the angle [rad] at `t` [s]."""
        return _bezier(self._parameter((t - self.start) / self.duration), self.a0, self.a1, self.a2, self.a3)

    def peak_speed(self) -> float:
        """Return the peak speed in the segment [rad/s], from 64 samples."""
        times = [self.start + self.duration * i / 64 for i in range(65)]
        angles = [self.at(t) for t in times]
        return max(abs(b - a) for a, b in pairwise(angles)) * 64 / self.duration

    def extremes(self) -> tuple[float, float]:
        """Return the smallest and the greatest angle [rad], from 64 samples."""
        angles = [_bezier(i / 64, self.a0, self.a1, self.a2, self.a3) for i in range(65)]
        return min(angles), max(angles)

    def _parameter(self, x: float) -> float:
        """Return the curve's parameter at the relative time `x`, by Newton's method safeguarded with bisection."""
        low, high, u = 0.0, 1.0, x
        for _ in range(40):
            error = _bezier(u, 0.0, self.x1, self.x2, 1.0) - x
            if abs(error) < 1e-12:
                break
            low, high = (low, u) if error > 0 else (u, high)
            slope = 3 * ((1 - u) ** 2 * self.x1 + 2 * (1 - u) * u * (self.x2 - self.x1) + u * u * (1 - self.x2))
            step = u - error / slope if slope > 1e-9 else low
            u = step if low < step < high else (low + high) / 2
        return u


Segment = Polynomial | Bezier


def _bezier(u: float, p0: float, p1: float, p2: float, p3: float) -> float:
    v = 1.0 - u
    return v * v * v * p0 + 3.0 * v * u * (v * p1 + u * p2) + u * u * u * p3


_SMOOTH = (Interpolation.CUBIC, Interpolation.BEZIER)


class JointTrack(NamedTuple):
    """The path of one joint: `segments[i]` ends at `ends[i]` [s]; after the last it stays at `last` [rad]."""

    joint: str
    first: float
    last: float
    ends: Sequence[float]
    segments: Sequence[Segment]

    def at(self, t: float) -> float:
        """Return the angle [rad] at `t` [s]."""
        if t <= 0.0:
            return self.first
        i = bisect_right(self.ends, t)  # at a key the next segment begins, exactly at its angle
        return self.segments[i].at(t) if i < len(self.segments) else self.last


class Trajectory:
    """A motion compiled for one performance, from the joints' angles `start` [rad] at its beginning.

    Joints missing in `start` begin in the motion's start posture, else at their first key.
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
        """Return the angle [rad; a hand 0..1] at `t` [s] of every joint of the motion; constant before and after."""
        return {track.joint: track.at(t) for track in self.tracks}


def sample(motion: MotionDefinition, t: float, start: Mapping[str, float] | None = None) -> dict[str, float]:
    """Return one sample of `Trajectory(motion, start)`; callers that need many should keep the Trajectory."""
    return Trajectory(motion, start).sample(t)


def track(joint: str, keys: Sequence[Keyframe], start: float) -> JointTrack:
    """Return the track through `keys` from the angle `start` [rad] at time 0."""
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
    """Return a handle (time from its key [s], angle [rad]), shortened to the segment: time never runs backwards."""
    dt, da = given
    if dt <= 0.0:
        return h / 3, automatic
    return (dt, da) if dt <= h else (h, da * h / dt)


def _slopes(points: Sequence[Keyframe]) -> list[float]:
    """Return the speed of a smooth curve at each key [rad/s]: 0 at an extreme and next to keys of another kind."""
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
