"""Limits that connect Reachy Mini's joints: the body follows the head, and the head stays within reach of its rods."""

from collections.abc import Mapping
from math import radians

from lumen.features.reachy.pose import BODY, JOINTS
from lumen.features.reachy.rods import MOST_AGAINST_BODY, within_reach
from lumen.language.robots import Body

FREE = radians(55)
"""The angle between head and body beyond which the body follows [rad]: less than its limit of 65 degrees."""


def possible(joints: Mapping[str, float], body: Body) -> dict[str, float]:
    """Return positions near `joints` that the robot can reach [rad, m].

    They are within the joints' limits; the body follows the head, and the head is within reach of its rods.
    """
    found = {name: min(max(joints[name], body.joints[name].minimum), body.joints[name].maximum) for name in JOINTS}
    trunk, yaw = body.joints[BODY], found["head_yaw"]
    followed = min(max(found[BODY], yaw - FREE), yaw + FREE)
    found[BODY] = min(max(followed, trunk.minimum), trunk.maximum)
    return within_reach(found)


def limited(goal: Mapping[str, float], last: Mapping[str, float], body: Body, dt: float) -> dict[str, float]:
    """Return the positions [rad, m] that joints reach from `last` towards `goal` in `dt` [s] at their greatest speeds.

    Because of its cables, the head turns at most MOST_AGAINST_BODY from the slower body. It stays within reach of the
    rods.
    """
    found = {}
    for name in JOINTS:
        most, way = body.joints[name].speed * dt, goal[name] - last[name]
        found[name] = last[name] + min(max(way, -most), most)
    trunk = found[BODY]
    found["head_yaw"] = min(max(found["head_yaw"], trunk - MOST_AGAINST_BODY), trunk + MOST_AGAINST_BODY)
    return within_reach(found)
