"""Computes which poses of Reachy Mini's head its six rods reach, by the inverse kinematics of a Stewart platform.

Each rod connects the tip of a motor's arm with the platform beneath the head. The dimensions in `kinematics_data.json`
and the motors' limits are copied from `reachy-mini` 1.13.0 (Pollen Robotics, Apache-2.0). Its own solver returns the
same angles (`tests/features/reachy/test_rods.py`).
"""

from collections.abc import Mapping
from math import acos, atan2, cos, hypot, pi, radians, sin
from typing import NamedTuple

from lumen.features.reachy.pose import BODY, HEAD, rotation
from lumen.language.robots import Body

ARM, ROD = 0.04, 0.085
"""The lengths of a motor's arm and of a rod [m]."""
HEIGHT = 0.177
"""The height of the platform above the table if the head's position is 0 [m]."""
MOST_AGAINST_BODY = radians(65)
"""The greatest angle between head and body [rad]."""
STEPS = 12
"""The number of bisections on the line to a pose beyond reach: exact to a four-thousandth of its length."""


class Motor(NamedTuple):
    """A motor beneath the head, in the body's frame of reference."""

    place: tuple[float, float, float]
    """The position of the motor [m]."""
    along: tuple[float, float]
    """The horizontal direction of its arm at angle 0, a unit vector."""
    up: float
    """1 if the arm points up at a quarter turn, -1 if it points down."""
    joint: tuple[float, float]
    """The position of its rod's joint with the platform [m], in the platform's frame."""
    elbow: float
    """The choice between the two possible angles: 1 or -1."""
    limits: tuple[float, float]
    """The minimum and the maximum angle [rad]."""


C, S = cos(pi / 6), sin(pi / 6)
MOTORS = (
    Motor((0.026991, 0.026749, 0.076633), (C, -S), 1.0, (0.020648, 0.021764), -1.0, (-0.8378, 1.3963)),
    Motor((0.009670, 0.036749, 0.076633), (-C, S), -1.0, (0.008524, 0.028764), 1.0, (-1.3963, 1.2217)),
    Motor((-0.036661, 0.010000, 0.076633), (0.0, 1.0), 1.0, (-0.029172, 0.007000), -1.0, (-0.8378, 1.3963)),
    Motor((-0.036661, -0.010000, 0.076633), (0.0, -1.0), -1.0, (-0.029172, -0.007000), 1.0, (-1.3963, 0.8378)),
    Motor((0.009670, -0.036749, 0.076633), (-C, -S), 1.0, (0.008524, -0.028764), -1.0, (-1.2217, 1.3963)),
    Motor((0.026991, -0.026749, 0.076633), (C, S), -1.0, (0.020648, -0.021764), 1.0, (-1.3963, 0.8378)),
)


def motor_angles(head: Mapping[str, float], body: float) -> tuple[float | None, ...]:
    """Return each motor's angle [rad] for a pose of the head, with the body at `body` [rad].

    The angle is None for a motor whose rod can't span the distance. The motors' limits are ignored.
    """
    x, y, z, roll, pitch, yaw = (head[name] for name in HEAD)
    turned = rotation(roll, pitch, yaw - body)
    c, s = cos(body), sin(body)
    place = (c * x + s * y, c * y - s * x, z + HEIGHT)
    found: list[float | None] = []
    for motor in MOTORS:
        u, v = motor.joint
        p, q, r = (row[0] * u + row[1] * v + at - own for row, at, own in zip(turned, place, motor.place, strict=True))
        along, up = motor.along[0] * p + motor.along[1] * q, motor.up * r
        far = hypot(along, up)
        bend = (p * p + q * q + r * r + ARM * ARM - ROD * ROD) / (2 * ARM)
        if abs(bend) > far:
            found.append(None)
        else:
            angle = atan2(up, along) + motor.elbow * acos(bend / far)
            found.append((angle + pi) % (2 * pi) - pi)
    return tuple(found)


def reaches(head: Mapping[str, float], body: float) -> bool:
    """Return whether the rods and motors reach a pose of the head, with the body at `body` [rad]."""
    if abs(head["head_yaw"] - body) > MOST_AGAINST_BODY + 1e-6:
        return False
    angles = motor_angles(head, body)
    return all(a is not None and m.limits[0] <= a <= m.limits[1] for a, m in zip(angles, MOTORS, strict=True))


def within_reach(joints: Mapping[str, float]) -> dict[str, float]:
    """Return the joints, with the head's pose scaled towards zero until the rods reach it.

    The yaw is kept. Joints within reach are returned unchanged.
    """
    if reaches(joints, joints[BODY]):
        return dict(joints)

    def part(share: float) -> dict[str, float]:
        return {**joints, **{name: share * joints[name] for name in HEAD[:5]}}

    low, high = 0.0, 1.0
    for _ in range(STEPS):
        middle = (low + high) / 2
        low, high = (middle, high) if reaches(part(middle), joints[BODY]) else (low, middle)
    return part(low)


def stands_on_rods(body: Body) -> bool:
    """Return whether a body is a Reachy Mini, by the joints of its head and body."""
    return {*HEAD, BODY} <= body.joints.keys()
