"""The way of one joint between two keys, as a curve over time."""

from itertools import pairwise
from typing import NamedTuple


class Polynomial(NamedTuple):
    """c0 + c1 u + … + c5 u^5, with u from 0 to 1 between `start` and `start + duration` [s]."""

    start: float
    duration: float
    c0: float
    c1: float
    c2: float = 0.0
    c3: float = 0.0
    c4: float = 0.0
    c5: float = 0.0

    def at(self, t: float) -> float:
        u = (t - self.start) / self.duration
        return self.c0 + u * (self.c1 + u * (self.c2 + u * (self.c3 + u * (self.c4 + u * self.c5))))

    def peak_speed(self) -> float:
        """The greatest speed in the segment [rad/s]; exact for lines, cubics and minimum jerk."""
        moments = [0.0, 0.5, 1.0]
        if self.c3 and 0.0 < (vertex := -self.c2 / (3 * self.c3)) < 1.0:
            moments.append(vertex)
        return max(abs(self._slope(u)) for u in moments) / self.duration

    def extremes(self) -> tuple[float, float]:
        """The least and the greatest angle: its ends, for no polynomial here leaves them."""
        first, last = self.c0, self.c0 + self.c1 + self.c2 + self.c3 + self.c4 + self.c5
        return min(first, last), max(first, last)

    def _slope(self, u: float) -> float:
        return self.c1 + u * (2 * self.c2 + u * (3 * self.c3 + u * (4 * self.c4 + u * 5 * self.c5)))


class Bezier(NamedTuple):
    """A cubic Bezier curve; `x1`, `x2` place its inner points in time, from 0 to 1, `a0` to `a3` are angles [rad]."""

    start: float
    duration: float
    x1: float
    x2: float
    a0: float
    a1: float
    a2: float
    a3: float

    def at(self, t: float) -> float:
        return _bezier(self._parameter((t - self.start) / self.duration), self.a0, self.a1, self.a2, self.a3)

    def peak_speed(self) -> float:
        """The greatest speed in the segment [rad/s], from 64 samples."""
        times = [self.start + self.duration * i / 64 for i in range(65)]
        angles = [self.at(t) for t in times]
        return max(abs(b - a) for a, b in pairwise(angles)) * 64 / self.duration

    def extremes(self) -> tuple[float, float]:
        """The least and the greatest angle, from 64 samples."""
        angles = [_bezier(i / 64, self.a0, self.a1, self.a2, self.a3) for i in range(65)]
        return min(angles), max(angles)

    def _parameter(self, x: float) -> float:
        """The curve's parameter where it has reached `x` of its time: bisection, kept fast by Newton's steps."""
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
