"""A pair of legs: joint angles from the poses of the feet, and back."""

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
"""The sides as they are called in roles."""

RotationMatrix = NDArray[np.float64]
LegVector = NDArray[np.float64]
LegAngles = tuple[float, float, float, float, float, float]
"""The joints of a leg [rad] in the order of `LEG_ROLES`: yaw to the left, roll to the right, pitch forward."""

_STRETCHED = 1e-4


class Placed(NamedTuple):
    """A foot: the pose of its sole on the ground, and the height of the sole above it [m]."""

    pose: Pose
    height: float = 0.0


class SoleSize(NamedTuple):
    """The distances from the point below the ankle to the edges of the sole [m]."""

    toe: float
    heel: float
    outer: float
    inner: float


@dataclass(frozen=True, slots=True)
class LegGeometry:
    """The dimensions of a pair of legs, and the names and conventions of its joints.

    Three axes meet in the hip (yaw, roll, pitch from the torso down), two in the ankle, with the knee between them:
    such a leg has inverse kinematics in closed form. For each side, in the order of `LEG_ROLES`, the robot's own angle
    of a joint in `names` is `signs` * (angle - `offsets`).
    """

    hip_ahead: float
    """Distance of the hips' middle ahead of the torso's origin [m]."""
    hip_out: float
    """Distance of a hip from the middle [m]."""
    hip_down: float
    """Distance of the hips below the torso's origin [m]."""
    thigh: float
    """Distance from hip to knee [m]."""
    tibia: float
    """Distance from knee to ankle [m]."""
    foot: float
    """Height of the ankle above the sole [m]."""
    inclination: float
    """Inward inclination of the yaw axis from the vertical [rad]."""
    shared: bool
    """True if both yaws share one motor."""
    sole_size: SoleSize
    """Extent of a sole."""
    speed: float
    """Speed of the slowest pitch joint [rad/s]."""
    names: Mapping[Side, tuple[str, ...]]
    """The robot's own names of the joints, in the order of `LEG_ROLES`."""
    signs: Mapping[Side, tuple[float, ...]]
    """1 or -1 for each joint: the sign of its own angle, relative to the leg angle."""
    offsets: Mapping[Side, tuple[float, ...]]
    """The leg angle at which each joint is at 0 [rad]."""

    @property
    def length(self) -> float:
        """The length of the stretched leg from hip to ankle [m]."""
        return self.thigh + self.tibia

    def joints(self, side: Side, angles: LegAngles) -> dict[str, float]:
        """Return these leg angles as joint angles in the robot's own convention [rad]."""
        ways = zip(self.names[side], self.signs[side], angles, self.offsets[side], strict=True)
        return {name: sign * (angle - offset) for name, sign, angle, offset in ways}

    def angles(self, side: Side, joints: Mapping[str, float]) -> LegAngles:
        """Return the leg angles for these joint angles of the robot [rad]."""
        yaw, roll, pitch, knee, ankle, tilt = (
            sign * joints[name] + offset
            for name, sign, offset in zip(self.names[side], self.signs[side], self.offsets[side], strict=True)
        )
        return yaw, roll, pitch, knee, ankle, tilt

    def hip(self, side: Side) -> tuple[float, float, float]:
        """Return the point where the axes of that hip meet, in the torso's frame [m]."""
        return self.hip_ahead, sign(side) * self.hip_out, -self.hip_down

    def bend(self, side: Side, rotation: RotationMatrix, ankle: LegVector) -> LegAngles:
        """Return the leg angles that put the ankle at a point.

        `rotation` (3, 3) of the foot and `ankle` (3,) [m] are in the torso's frame. For a point out of reach, the leg
        stretches towards it.
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
        """Return the sole's rotation (3, 3) and place (3,) [m] in the torso's frame, for these joints [rad]."""
        yaw, roll, pitch, knee, ankle, tilt = self.angles(side, joints)
        lean = sign(side) * self.inclination
        hip = _about_x(lean) @ _about_z(yaw) @ _about_x(roll - lean)
        thigh, tibia = hip @ _about_y(pitch), hip @ _about_y(pitch + knee)
        foot = tibia @ _about_y(ankle) @ _about_x(tilt)
        down = -self.thigh * thigh[:, 2] - self.tibia * tibia[:, 2] - self.foot * foot[:, 2]
        return foot, np.array(self.hip(side)) + down

    def foot_from(self, side: Side, joints: Mapping[str, float]) -> Pose:
        """Return the pose of the other foot relative to this one, which is flat on the ground."""
        (here, origin), (there, place) = self.sole(side, joints), self.sole(other(side), joints)
        x, y, _ = here.T @ (place - origin)
        turned = here.T @ there
        return Pose(float(x), float(y), atan2(turned[1, 0], turned[0, 0]))


def other(side: Side) -> Side:
    """Return the opposite side."""
    return "R" if side == "L" else "L"


def sign(side: Side) -> int:
    """Return 1 for the left side, -1 for the right."""
    return 1 if side == "L" else -1


def torso_rotation(yaw: float, lean: float) -> RotationMatrix:
    """Return the rotation (3, 3) of a torso turned by `yaw` and inclined forward by `lean` [rad], without roll."""
    rotation: RotationMatrix = _about_z(yaw) @ _about_y(lean)
    return rotation


def heading_rotation(yaw: float) -> RotationMatrix:
    """Return the rotation (3, 3) of a level object that is turned to the left by `yaw` [rad]."""
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
