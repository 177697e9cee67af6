"""NAO's legs: from where the feet are to what the joints do, and back."""

from collections.abc import Mapping
from math import acos, asin, atan2, cos, hypot, pi, sin, sqrt
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lumen.interpreters.gait.poses import Pose

Side = Literal["L", "R"]
SIDES: tuple[Side, Side] = ("L", "R")

JOINTS = ("HipYawPitch", "HipRoll", "HipPitch", "KneePitch", "AnklePitch", "AnkleRoll")
"""From the hip down; with `L` or `R` before them they are NAOqi's names."""

HIP_OUT, HIP_DOWN = 0.05, 0.085
"""Where the hip joints' axes meet, beside and below the torso's origin [m]."""

THIGH, TIBIA, FOOT = 0.1, 0.1029, 0.04511
"""Hip to knee, knee to ankle, ankle to sole [m]."""

STRETCHED = THIGH + TIBIA - 1e-4
_SLOPE = 2.7
_YAW_STEP, _YAW_ERROR, _ROUNDS = 0.2, 1e-4, 6

RotationMatrix = NDArray[np.float64]
LegVector = NDArray[np.float64]


class Placed(NamedTuple):
    """A foot: its sole's pose on the ground and how high it is lifted [m]."""

    pose: Pose
    height: float = 0.0


def other(side: Side) -> Side:
    return "R" if side == "L" else "L"


def sign(side: Side) -> int:
    """1 on the left, -1 on the right."""
    return 1 if side == "L" else -1


def bend(side: Side, rotation: RotationMatrix, ankle: LegVector) -> tuple[float, ...]:
    """The joints of a leg [rad], in the order of `JOINTS`, that put its ankle there.

    `rotation` (3, 3) of the foot and `ankle` (3,) [m] in the torso's frame. A place out of reach is approached as far
    as the leg goes. Closed form: hip yaw pitch is a yaw about an axis inclined by 45 degrees.
    """
    s = sign(side)
    hip = -rotation.T @ (ankle - (0.0, s * HIP_OUT, -HIP_DOWN))
    x, y, z = hip * min(1.0, STRETCHED / sqrt(hip @ hip))
    reach = x * x + y * y + z * z
    knee = acos(min(1.0, max(-1.0, (reach - THIGH**2 - TIBIA**2) / (2 * THIGH * TIBIA))))
    roll = atan2(y, z)
    pitch = atan2(-THIGH * sin(knee), TIBIA + THIGH * cos(knee)) - atan2(x, hypot(y, z))
    m = _about_x(-s * pi / 4) @ rotation @ _about_x(-roll) @ _about_y(-knee - pitch)
    yaw, tilt, swing = atan2(-m[0, 1], m[1, 1]), asin(min(1.0, max(-1.0, m[2, 1]))), atan2(-m[2, 0], m[2, 2])
    return -s * yaw, tilt + s * pi / 4, swing, knee, pitch, roll


def sole(side: Side, angles: Mapping[str, float]) -> tuple[RotationMatrix, LegVector]:
    """The sole's rotation (3, 3) and place (3,) [m] in the torso's frame, of joints by NAOqi's names [rad]."""
    yaw, roll, pitch, knee, ankle, tilt = (angles[side + name] for name in JOINTS)
    s = sign(side)
    hip = _about_x(s * pi / 4) @ _about_z(-s * yaw) @ _about_x(roll - s * pi / 4)
    thigh, tibia = hip @ _about_y(pitch), hip @ _about_y(pitch + knee)
    foot = tibia @ _about_y(ankle) @ _about_x(tilt)
    down = -THIGH * thigh[:, 2] - TIBIA * tibia[:, 2] - FOOT * foot[:, 2]
    return foot, np.array([0.0, s * HIP_OUT, -HIP_DOWN]) + down


def foot_from(side: Side, angles: Mapping[str, float]) -> Pose:
    """The pose of the other foot seen from this one, which stands flat on the ground."""
    (here, origin), (there, place) = sole(side, angles), sole(other(side), angles)
    x, y, _ = here.T @ (place - origin)
    turned = here.T @ there
    return Pose(float(x), float(y), atan2(turned[1, 0], turned[0, 0]))


class Stance(NamedTuple):
    """Joints [rad] by NAOqi's names, and the torso's heading [rad] that they give it."""

    angles: dict[str, float]
    yaw: float


def stand(torso: complex, height: float, lean: float, yaw: float, feet: Mapping[Side, Placed]) -> Stance:
    """The joints that carry the torso over `torso` at `height` [m], leant forward by `lean` [rad].

    Both hips share one yaw pitch motor, so that the torso's heading follows from the feet: it is sought from `yaw` on,
    along secants, until both legs want the same of it.
    """
    bent, slope = _bend_both(torso, height, lean, yaw, feet), _SLOPE
    apart = bent["L"][0] - bent["R"][0]
    for _ in range(_ROUNDS):
        if abs(apart) < _YAW_ERROR:
            break
        step = min(max(-apart / slope, -_YAW_STEP), _YAW_STEP)
        yaw, before = yaw + step, apart
        bent = _bend_both(torso, height, lean, yaw, feet)
        apart = bent["L"][0] - bent["R"][0]
        slope = min(max((apart - before) / step, _SLOPE / 2), 2 * _SLOPE)
    angles = {side + name: angle for side in SIDES for name, angle in zip(JOINTS, bent[side], strict=True)}
    return Stance(angles, yaw)


def torso_rotation(yaw: float, lean: float) -> RotationMatrix:
    """The torso's rotation (3, 3), which does not roll."""
    rotation: RotationMatrix = _about_z(yaw) @ _about_y(lean)
    return rotation


def _bend_both(
    torso: complex, height: float, lean: float, yaw: float, feet: Mapping[Side, Placed]
) -> dict[Side, tuple[float, ...]]:
    upright = torso_rotation(yaw, lean).T
    bent: dict[Side, tuple[float, ...]] = {}
    for side, (pose, lifted) in feet.items():
        to = pose.place - torso
        ankle = upright @ np.array([to.real, to.imag, lifted + FOOT - height])
        bent[side] = bend(side, upright @ _about_z(pose.theta), ankle)
    return bent


def _about_x(angle: float) -> RotationMatrix:
    c, s = cos(angle), sin(angle)
    return np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])


def _about_y(angle: float) -> RotationMatrix:
    c, s = cos(angle), sin(angle)
    return np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])


def _about_z(angle: float) -> RotationMatrix:
    c, s = cos(angle), sin(angle)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
