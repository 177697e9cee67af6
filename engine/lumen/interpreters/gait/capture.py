"""Where a foot has to land to catch a fall, and how a leg holds it level on the way.

A body falls away from the point it rests on, its DCM exponentially: seen now, it says where it will be when the foot
lands. There the foot has to stand (Pratt and others, "Capture point: a step toward humanoid push recovery", 2006).
Points are (forward, left) [m], level with the ground, seen from the bearing sole.
"""

from math import asin, atan2, copysign, exp, sin

import numpy as np
from numpy.typing import NDArray

from lumen.interpreters.gait.footsteps import HEEL, INNER, NARROWEST, OUTER, TOE
from lumen.interpreters.gait.legs import FOOT, HIP_DOWN, HIP_OUT, THIGH, TIBIA, Side, bend, sign

FARTHEST, WIDEST_CATCH = 0.2, 0.2
"""How far ahead or behind, and aside, a foot can be put down [m]."""

BEYOND = 0.02
"""How far beyond the DCM the middle of the sole is put down [m]: what is short costs a second step."""

MIDDLE = (TOE - HEEL) / 2
"""The sole's middle, in front of the point below the ankle [m]."""

HIP_STRETCHED = 0.47
"""No thigh goes farther back than this [rad]: beyond it the knee has to."""

_GAP = 0.01
_SLOPE, _STEP, _ERROR, _ROUNDS = 1.4, 0.2, 1e-3, 4

CapturePoint = NDArray[np.float64]


def landing(dcm: CapturePoint, omega: float, left: float, bears: Side) -> CapturePoint:
    """Where the foot that swings has to land in `left` [s], while the body rests on the sole that bears.

    Nowhere that it could not reach, and not on the other foot.
    """
    out = sign(bears)
    rest = np.array([min(max(dcm[0], -HEEL), TOE), out * min(max(out * dcm[1], -INNER), OUTER)])
    end = rest + (dcm - rest) * exp(omega * left)
    ahead = end[0] - MIDDLE
    ahead = min(max(ahead + copysign(BEYOND, ahead), -FARTHEST), FARTHEST)
    apart = min(max(-out * end[1], NARROWEST + _GAP), WIDEST_CATCH)
    return np.array([ahead, -out * apart])


def hold_level(side: Side, axes: NDArray[np.float64], sole: NDArray[np.float64], yaw: float) -> tuple[float, ...]:
    """The joints of a leg [rad], in the order of `JOINTS`, that hold its sole there and level, whatever the torso does.

    `axes` (3, 3) are forward, left and up in the torso's frame; `sole` (3,) [m] is seen from the torso along them. The
    hip yaw pitch stays as it is (`yaw`), for the other leg shares its motor: the foot points where it then does.
    """
    ankle = axes.T @ (sole + np.array((0.0, 0.0, FOOT)))

    def bent(theta: float) -> tuple[float, ...]:
        c, s = np.cos(theta), np.sin(theta)
        return bend(side, axes.T @ np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]), ankle)

    theta, slope = 0.0, -sign(side) * _SLOPE
    joints = bent(theta)
    for _ in range(_ROUNDS):
        wrong = joints[0] - yaw
        if abs(wrong) < _ERROR:
            break
        step = min(max(-wrong / slope, -_STEP), _STEP)
        theta, before, joints = theta + step, joints[0], bent(theta + step)
        slope = (joints[0] - before) / step if abs(joints[0] - before) > _ERROR / 10 else slope
    _, roll, hip, knee, pitch, tilt = joints
    if hip > HIP_STRETCHED:
        back = atan2(axes[2, 0], axes[2, 2])
        ahead = float(axes[0] @ (ankle - (0.0, sign(side) * HIP_OUT, -HIP_DOWN)))
        far = min(max((-ahead - THIGH * sin(HIP_STRETCHED - back)) / TIBIA, -0.95), 0.95)
        level = hip + knee + pitch
        hip, knee = HIP_STRETCHED, asin(far) + back - HIP_STRETCHED
        pitch = level - hip - knee
    return yaw, roll, hip, knee, pitch, tilt
