"""A foot in the air: its swing, where it has to land to catch a fall, and how a leg holds it level on the way.

A body falls away from the point it rests on, its DCM exponentially: seen now, it says where it will be when the foot
lands. There the foot has to stand (Pratt and others, "Capture point: a step toward humanoid push recovery", 2006).
Points are (forward, left) [m], level with the ground, seen from the bearing sole.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from math import asin, atan2, copysign, cos, exp, pi, sin

import numpy as np
from numpy.typing import NDArray

from lumen.motion.gait.legs import LegAngles, LegGeometry, Placed, Side, heading_rotation, sign
from lumen.motion.gait.parameters import GaitParameters, scale_of
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


FARTHEST, WIDEST_CATCH = 0.2, 0.2
"""How far ahead or behind, and aside, a foot can be put down [m], by legs as long as those it was found with."""

BEYOND = 0.02
"""How far beyond the DCM the middle of the sole is put down [m], by such legs: what is short costs a second step."""

HIP_STRETCHED = 0.47
"""No thigh goes farther back than this [rad]: beyond it the knee has to."""

_GAP = 0.01
_STEP, _ERROR, _ROUNDS = 0.2, 1e-3, 4

CapturePoint = NDArray[np.float64]


def landing(
    legs: LegGeometry, pace: GaitParameters, dcm: CapturePoint, omega: float, left: float, bears: Side
) -> CapturePoint:
    """Where the foot that swings has to land in `left` [s], while the body rests on the sole that bears.

    Nowhere that it could not reach, and not on the other foot.
    """
    out, sole, scale = sign(bears), legs.sole_size, scale_of(legs)
    rest = np.array([min(max(dcm[0], -sole.heel), sole.toe), out * min(max(out * dcm[1], -sole.inner), sole.outer)])
    end = rest + (dcm - rest) * exp(omega * left)
    ahead = end[0] - (sole.toe - sole.heel) / 2
    ahead = min(max(ahead + copysign(BEYOND * scale, ahead), -FARTHEST * scale), FARTHEST * scale)
    apart = min(max(-out * end[1], pace.narrowest + _GAP * scale), WIDEST_CATCH * scale)
    return np.array([ahead, -out * apart])


def hold_level(
    legs: LegGeometry, side: Side, axes: NDArray[np.float64], sole: NDArray[np.float64], joints: Mapping[str, float]
) -> dict[str, float]:
    """The joints of a leg [rad] that hold its sole there and level, whatever the torso does.

    `axes` (3, 3) are forward, left and up in the torso's frame; `sole` (3,) [m] is seen from the torso along them. The
    hip's yaw stays as it is in `joints`, for the other leg may share its motor: the foot points where it then does.
    """
    ankle = axes.T @ (sole + np.array((0.0, 0.0, legs.foot)))
    yaw = legs.angles(side, joints)[0]

    def bent(theta: float) -> LegAngles:
        return legs.bend(side, axes.T @ heading_rotation(theta), ankle)

    theta, slope = 0.0, round(1 / cos(legs.inclination), 1)
    angles = bent(theta)
    for _ in range(_ROUNDS):
        wrong = angles[0] - yaw
        if abs(wrong) < _ERROR:
            break
        step = min(max(-wrong / slope, -_STEP), _STEP)
        theta, before, angles = theta + step, angles[0], bent(theta + step)
        slope = (angles[0] - before) / step if abs(angles[0] - before) > _ERROR / 10 else slope
    _, roll, hip, knee, pitch, tilt = angles
    if hip > HIP_STRETCHED:
        back = atan2(axes[2, 0], axes[2, 2])
        ahead = float(axes[0] @ (ankle - legs.hip(side)))
        far = min(max((-ahead - legs.thigh * sin(HIP_STRETCHED - back)) / legs.tibia, -0.95), 0.95)
        level = hip + knee + pitch
        hip, knee = HIP_STRETCHED, asin(far) + back - HIP_STRETCHED
        pitch = level - hip - knee
    return legs.joints(side, (yaw, roll, hip, knee, pitch, tilt))
