"""A pair of legs: from where the feet are to what the joints do, and back."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import acos, asin, atan2, cos, hypot, sin, sqrt
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lumen.motion.gait.poses import Pose

Side = Literal["L", "R"]
SIDES: tuple[Side, Side] = ("L", "R")
SIDE_ROLES: Mapping[Side, str] = {"L": "left", "R": "right"}
"""The sides as roles have them."""

RotationMatrix = NDArray[np.float64]
LegVector = NDArray[np.float64]
LegAngles = tuple[float, float, float, float, float, float]
"""What the joints of a leg do [rad], in the order of `LEG_ROLES`: yaw to the left, roll to the right, pitch forward."""

_STRETCHED = 1e-4


class Placed(NamedTuple):
    """A foot: its sole's pose on the ground and how high it is lifted [m]."""

    pose: Pose
    height: float = 0.0


class SoleSize(NamedTuple):
    """How far a sole reaches from the point below the ankle [m]."""

    toe: float
    heel: float
    outer: float
    inner: float


@dataclass(frozen=True, slots=True)
class LegGeometry:
    """What a pair of legs measures [m], [rad], and how its joints are called and counted.

    Three axes meet in the hip (yaw, roll, pitch from the torso down), two in the ankle, and the knee lies between: that
    has a closed form. The hips' middle is `hip_ahead` of the torso's origin, `hip_out` beside and `hip_down` below it.
    `inclination` is how far the yaw axis leans inwards from upright; where both yaws share a motor, `shared`. `speed`
    is that of the slowest joint that pitches [rad/s]. For each side, a joint of `names` stands at `signs` times (angle
    minus `offsets`), in the order of `LEG_ROLES`.
    """

    hip_ahead: float
    hip_out: float
    hip_down: float
    thigh: float
    tibia: float
    foot: float
    inclination: float
    shared: bool
    sole_size: SoleSize
    speed: float
    names: Mapping[Side, tuple[str, ...]]
    signs: Mapping[Side, tuple[float, ...]]
    offsets: Mapping[Side, tuple[float, ...]]

    @property
    def length(self) -> float:
        """From hip to ankle, stretched [m]."""
        return self.thigh + self.tibia

    def joints(self, side: Side, angles: LegAngles) -> dict[str, float]:
        """These angles of a leg as the robot's own joints count them [rad]."""
        ways = zip(self.names[side], self.signs[side], angles, self.offsets[side], strict=True)
        return {name: sign * (angle - offset) for name, sign, angle, offset in ways}

    def angles(self, side: Side, joints: Mapping[str, float]) -> LegAngles:
        """What a leg does whose joints stand like this [rad]."""
        yaw, roll, pitch, knee, ankle, tilt = (
            sign * joints[name] + offset
            for name, sign, offset in zip(self.names[side], self.signs[side], self.offsets[side], strict=True)
        )
        return yaw, roll, pitch, knee, ankle, tilt

    def hip(self, side: Side) -> tuple[float, float, float]:
        """Where the axes of that hip meet in the torso's frame [m]."""
        return self.hip_ahead, sign(side) * self.hip_out, -self.hip_down

    def bend(self, side: Side, rotation: RotationMatrix, ankle: LegVector) -> LegAngles:
        """The angles of a leg that put its ankle there.

        `rotation` (3, 3) of the foot and `ankle` (3,) [m] in the torso's frame. A place out of reach is approached as
        far as the leg goes.
        """
        lean, thigh, tibia = sign(side) * self.inclination, self.thigh, self.tibia
        hip = -rotation.T @ (ankle - self.hip(side))
        x, y, z = hip * min(1.0, (self.length - _STRETCHED) / sqrt(hip @ hip))
        reach = x * x + y * y + z * z
        knee = acos(min(1.0, max(-1.0, (reach - thigh**2 - tibia**2) / (2 * thigh * tibia))))
        roll = atan2(y, z)
        pitch = atan2(-thigh * sin(knee), tibia + thigh * cos(knee)) - atan2(x, hypot(y, z))
        m = _about_x(-lean) @ rotation @ _about_x(-roll) @ _about_y(-knee - pitch)
        yaw, tilt, swing = atan2(-m[0, 1], m[1, 1]), asin(min(1.0, max(-1.0, m[2, 1]))), atan2(-m[2, 0], m[2, 2])
        return yaw, tilt + lean, swing, knee, pitch, roll

    def sole(self, side: Side, joints: Mapping[str, float]) -> tuple[RotationMatrix, LegVector]:
        """The sole's rotation (3, 3) and place (3,) [m] in the torso's frame, of joints by the robot's names [rad]."""
        yaw, roll, pitch, knee, ankle, tilt = self.angles(side, joints)
        lean = sign(side) * self.inclination
        hip = _about_x(lean) @ _about_z(yaw) @ _about_x(roll - lean)
        thigh, tibia = hip @ _about_y(pitch), hip @ _about_y(pitch + knee)
        foot = tibia @ _about_y(ankle) @ _about_x(tilt)
        down = -self.thigh * thigh[:, 2] - self.tibia * tibia[:, 2] - self.foot * foot[:, 2]
        return foot, np.array(self.hip(side)) + down

    def foot_from(self, side: Side, joints: Mapping[str, float]) -> Pose:
        """The pose of the other foot seen from this one, which stands flat on the ground."""
        (here, origin), (there, place) = self.sole(side, joints), self.sole(other(side), joints)
        x, y, _ = here.T @ (place - origin)
        turned = here.T @ there
        return Pose(float(x), float(y), atan2(turned[1, 0], turned[0, 0]))


def other(side: Side) -> Side:
    return "R" if side == "L" else "L"


def sign(side: Side) -> int:
    """1 on the left, -1 on the right."""
    return 1 if side == "L" else -1


def torso_rotation(yaw: float, lean: float) -> RotationMatrix:
    """The torso's rotation (3, 3), which does not roll."""
    rotation: RotationMatrix = _about_z(yaw) @ _about_y(lean)
    return rotation


def heading_rotation(yaw: float) -> RotationMatrix:
    """The rotation (3, 3) of what stands level and is turned to the left by that [rad]."""
    return _about_z(yaw)


def _about_x(angle: float) -> RotationMatrix:
    c, s = cos(angle), sin(angle)
    return np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])


def _about_y(angle: float) -> RotationMatrix:
    c, s = cos(angle), sin(angle)
    return np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])


def _about_z(angle: float) -> RotationMatrix:
    c, s = cos(angle), sin(angle)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
