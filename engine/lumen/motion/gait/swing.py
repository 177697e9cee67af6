"""A foot in the air."""

from dataclasses import dataclass
from math import cos, pi

from lumen.motion.gait.legs import Placed, Side
from lumen.motion.gait.poses import Pose

_LEAVES, _ARRIVES = 0.05, 0.95


@dataclass(slots=True)
class Swing:
    """From where a foot stood to where it will stand: up and down along a cosine, across along a minimum jerk curve.

    `turned` is the part of the way at which a new `goal` was given; until then the foot was on the way to `old`.
    """

    side: Side
    start: Pose
    goal: Pose
    lift: float
    old: Pose | None = None
    turned: float = 0.0

    def at(self, part: float) -> Placed:
        """Where the foot is after that part (0..1) of its time."""
        done = smooth((part - _LEAVES) / (_ARRIVES - _LEAVES))
        goal = self.goal
        if self.old:
            goal = self.old.toward(goal, smooth((part - self.turned) / (_ARRIVES - self.turned)))
        return Placed(self.start.toward(goal, done), self.lift * (1 - cos(2 * pi * min(part, 1.0))) / 2)

    def turn(self, part: float, goal: Pose) -> None:
        """Go elsewhere from that part of the way on, without a jerk."""
        self.old, self.turned, self.goal = self.goal, part, goal


def smooth(u: float) -> float:
    """From 0 to 1 along a minimum jerk curve."""
    u = min(max(u, 0.0), 1.0)
    return u * u * u * (10 - 15 * u + 6 * u * u)
