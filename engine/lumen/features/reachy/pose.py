"""Converts Reachy Mini's joint positions to its daemon's messages, and back."""

from collections.abc import Mapping, Sequence
from math import asin, atan2, cos, hypot, sin
from typing import Any

from lumen.motion.projection import Matrix3

HEAD = ("head_x", "head_y", "head_z", "head_roll", "head_pitch", "head_yaw")
"""The joints of the head, in the order of the daemon's x, y, z, roll, pitch and yaw: [m], then [rad]."""
BODY, LEFT, RIGHT = "body_yaw", "left_antenna", "right_antenna"
JOINTS = (*HEAD, BODY, LEFT, RIGHT)

LYING_HEIGHT, LYING_PITCH = -0.035, 0.3
"""A sleeping robot's head is lower than this height [m], and pitched beyond this angle [rad]; it sinks with time."""


def rotation(roll: float, pitch: float, yaw: float) -> Matrix3:
    """Return the rotation matrix Rz(yaw) Ry(pitch) Rx(roll) as a tuple of rows; angles in [rad]."""
    cr, sr, cp, sp, cy, sy = cos(roll), sin(roll), cos(pitch), sin(pitch), cos(yaw), sin(yaw)
    return (
        (cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr),
        (sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr),
        (-sp, cp * sr, cp * cr),
    )


def target_message(joints: Mapping[str, float]) -> dict[str, Any]:
    """Return the daemon's `set_full_target` for the positions of all joints [rad, m].

    `head` is the head's pose relative to the base, a 4 x 4 matrix in row order; `antennas` are right, left.
    """
    x, y, z, roll, pitch, yaw = (joints[name] for name in HEAD)
    rows = zip(rotation(roll, pitch, yaw), (x, y, z), strict=True)
    head = [number for row, along in rows for number in (*row, along)] + [0.0, 0.0, 0.0, 1.0]
    antennas = [joints[RIGHT], joints[LEFT]]
    return {"type": "set_full_target", "head": head, "antennas": antennas, "body_yaw": joints[BODY]}


def head_joints(pose: Sequence[Sequence[float]]) -> dict[str, float]:
    """Return the head's joints [rad, m] for its pose, a 4 x 4 matrix.

    Raises ValueError or TypeError for other data.
    """
    (r00, _, _, x), (r10, _, _, y), (r20, r21, r22, z), _ = (tuple(map(float, row)) for row in pose)
    roll, pitch, yaw = atan2(r21, r22), asin(min(max(-r20, -1.0), 1.0)), atan2(r10, r00)
    return dict(zip(HEAD, (x, y, z, roll, pitch, yaw), strict=True))


def motor_joints(message: Mapping[str, Any]) -> dict[str, float]:
    """Return the angles of body and antennas [rad] from the daemon's `joint_positions`.

    Raises ValueError, TypeError, KeyError or IndexError for other data.
    """
    right, left = map(float, message["antennas_joint_positions"])
    return {BODY: float(message["head_joint_positions"][0]), LEFT: left, RIGHT: right}


def lies(joints: Mapping[str, float]) -> bool:
    """Return whether the head rests on the body, as it does while the robot sleeps."""
    return joints["head_z"] < LYING_HEIGHT and joints["head_pitch"] > LYING_PITCH


def distance(joints: Mapping[str, float], others: Mapping[str, float]) -> tuple[float, float]:
    """Return the largest angular difference between two poses of head and body [rad], and the heads' distance [m].

    Antennas are left out because they swing.
    """
    angles = max(abs(joints[name] - others[name]) for name in (*HEAD[3:], BODY))
    return angles, hypot(*(joints[name] - others[name] for name in HEAD[:3]))
