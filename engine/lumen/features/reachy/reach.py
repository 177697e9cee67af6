"""Finds the poses of a motion that Reachy Mini's rods do not reach."""

from collections.abc import Mapping
from math import degrees, radians
from typing import NamedTuple

from lumen.features.reachy.following import possible
from lumen.features.reachy.pose import HEAD, JOINTS
from lumen.language.motions import MotionDefinition
from lumen.language.robots import Body
from lumen.motion.trajectories import Trajectory

SHORT_ANGLE, SHORT_LENGTH = radians(1.0), 0.001
"""A joint's distance from its goal above which it is reported [rad], [m]."""
SAMPLE_PERIOD = 0.05
"""The period with which a motion is sampled [s]."""


class Shortage(NamedTuple):
    """A joint that stays short of its goal."""

    joint: str
    goal: float
    """The position in the motion [rad, m]."""
    reached: float
    """The position that the rods allow [rad, m]."""
    time: float = 0.0
    """The time in the motion [s]."""

    @property
    def share(self) -> float:
        """The shortage as a multiple of SHORT_LENGTH or SHORT_ANGLE."""
        return abs(self.goal - self.reached) / (SHORT_LENGTH if self.joint in HEAD[:3] else SHORT_ANGLE)

    def __str__(self) -> str:
        return f"its rods let `{self.joint}` come to {self._shown(self.reached)}, not to {self._shown(self.goal)}"

    def _shown(self, value: float) -> str:
        return f"{1000 * value:.1f} mm" if self.joint in HEAD[:3] else f"{degrees(value):.1f} deg"


def shortest(goal: Mapping[str, float], near: Mapping[str, float], time: float = 0.0) -> Shortage | None:
    """Return the head's joint that is farthest from its goal in `near`; None if every joint is near enough."""
    worst = max((Shortage(name, goal[name], near[name], time) for name in HEAD), key=lambda short: short.share)
    return worst if worst.share > 1.0 else None


def worst_of(motion: MotionDefinition, body: Body) -> Shortage | None:
    """Return the greatest shortage of a joint in a motion; None if the robot reaches every sampled pose.

    Joints that the motion does not move are in the posture Stand.
    """
    course, stand = Trajectory(motion), {name: body.postures["Stand"][name] for name in JOINTS}
    found = []
    for i in range(int(motion.duration / SAMPLE_PERIOD) + 1):
        time = i * SAMPLE_PERIOD
        sampled = {name: angle for name, angle in course.sample(time).items() if name in stand}
        goal = {**stand, **sampled}
        if short := shortest(goal, possible(goal, body), time):
            found.append(short)
    return max(found, key=lambda short: short.share, default=None)


def shortfall(motion: MotionDefinition, body: Body) -> str:
    """Return a description of the pose that falls farthest short; empty if the robot reaches the whole motion."""
    worst = worst_of(motion, body)
    return f"`{motion.name}` falls short at {worst.time:.1f} s: {worst}" if worst else ""
