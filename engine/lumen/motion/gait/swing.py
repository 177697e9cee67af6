"""A foot in the air: its swing, the point at which it must land to catch a fall, and the angles that keep it level.

A body falls away from the point on which it rests, and its DCM moves exponentially, so the present DCM determines where
it will be when the foot lands. The foot must land there (Pratt and others, "Capture point: a step toward humanoid push
recovery", 2006). Points are (forward, left) [m], level with the ground, seen from the bearing sole.
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
    """The path of a foot to its next pose: a cosine in height, a minimum-jerk curve across the ground."""

    side: Side
    """The foot."""
    start: Pose
    """The pose that it leaves."""
    goal: Pose
    """The pose at which it lands."""
    lift: float
    """The greatest height of the sole [m]."""
    old: Pose | None = None
    """The former goal, if the goal was changed on the way."""
    turned: float = 0.0
    """The part of the time (0..1) after which the goal was changed."""

    def at(self, part: float) -> Placed:
        """Return the pose and height of the foot after `part` (0..1) of its time."""
        done = smooth((part - _LEAVES) / (_ARRIVES - _LEAVES))
        goal = self.goal
        if self.old:
            goal = self.old.toward(goal, smooth((part - self.turned) / (_ARRIVES - self.turned)))
        return Placed(self.start.toward(goal, done), self.lift * (1 - cos(2 * pi * min(part, 1.0))) / 2)

    def turn(self, part: float, goal: Pose) -> None:
        """Change the goal after `part` of the time, without a jerk."""
        self.old, self.turned, self.goal = self.goal, part, goal


def smooth(u: float) -> float:
    """Return a minimum-jerk curve from 0 to 1; `u` is limited to that range."""
    u = min(max(u, 0.0), 1.0)
    return u * u * u * (10 - 15 * u + 6 * u * u)


FARTHEST, WIDEST_CATCH = 0.2, 0.2
"""The farthest placement of a foot ahead or behind, and aside [m], for legs of the length `FOUND_LENGTH`."""

BEYOND = 0.02
"""Distance of the sole's middle beyond the DCM [m], for such legs: a step that is too short requires a second one."""

HIP_STRETCHED = 0.47
"""The greatest backward angle of a thigh [rad]; beyond it, the knee bends instead."""

_GAP = 0.01
_STEP, _ERROR, _ROUNDS = 0.2, 1e-3, 4

CapturePoint = NDArray[np.float64]


def landing(
    legs: LegGeometry, pace: GaitParameters, dcm: CapturePoint, omega: float, left: float, bears: Side
) -> CapturePoint:
    """Return where the swinging foot must land in `left` [s], while the body rests on the sole `bears`.

    The point is limited to the reach of the foot, and keeps clear of the other foot.
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
    """Return the joints of a leg [rad] that keep its sole at `sole` and level, however the torso is tilted.

    The rows of `axes` (3, 3) are forward, left and up in the torso's frame; `sole` (3,) [m] is relative to the torso
    along them. The hip's yaw stays as in `joints`, because the other leg may share its motor; the foot's heading
    follows from it.
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
