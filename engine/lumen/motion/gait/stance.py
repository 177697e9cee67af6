"""The joint angles of both legs that hold the torso at a given pose above the feet."""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from lumen.motion.gait.legs import (
    SIDES,
    LegAngles,
    LegGeometry,
    Placed,
    Side,
    heading_rotation,
    torso_rotation,
)

_SLOPE = 2.7
_YAW_STEP, _YAW_ERROR, _ROUNDS = 0.2, 1e-4, 6


class Stance(NamedTuple):
    """Joints [rad] by the robot's names, and the resulting heading of the torso [rad]."""

    angles: dict[str, float]
    yaw: float


def stand(
    legs: LegGeometry, torso: complex, height: float, lean: float, yaw: float, feet: Mapping[Side, Placed]
) -> Stance:
    """Return the stance with the torso at `height` [m] above the ground point `torso`, leaning forward by `lean` [rad].

    If both hips share one yaw motor, the heading of the torso follows from the feet: it is found by secant steps from
    `yaw` on, until both legs need the same motor angle. Otherwise the heading is halfway between those of the feet.
    """
    if legs.shared:
        yaw, bent = _agreed(legs, torso, height, lean, yaw, feet)
    else:
        yaw = feet["L"].pose.toward(feet["R"].pose, 0.5).theta
        bent = _bend_both(legs, torso, height, lean, yaw, feet)
    angles = {name: angle for side in SIDES for name, angle in legs.joints(side, bent[side]).items()}
    return Stance(angles, yaw)


def _agreed(
    legs: LegGeometry, torso: complex, height: float, lean: float, yaw: float, feet: Mapping[Side, Placed]
) -> tuple[float, dict[Side, LegAngles]]:
    """Return the heading at which both hips need the same angle of their shared motor, and the leg angles there."""
    inward = legs.signs["R"][0]
    bent, slope = _bend_both(legs, torso, height, lean, yaw, feet), inward * _SLOPE
    apart = _apart(legs, bent)
    for _ in range(_ROUNDS):
        if abs(apart) < _YAW_ERROR:
            break
        step = min(max(-apart / slope, -_YAW_STEP), _YAW_STEP)
        yaw, before = yaw + step, apart
        bent = _bend_both(legs, torso, height, lean, yaw, feet)
        apart = _apart(legs, bent)
        slope = inward * min(max(inward * (apart - before) / step, _SLOPE / 2), 2 * _SLOPE)
    return yaw, bent


def _apart(legs: LegGeometry, bent: Mapping[Side, LegAngles]) -> float:
    return legs.signs["L"][0] * bent["L"][0] - legs.signs["R"][0] * bent["R"][0]


def _bend_both(
    legs: LegGeometry, torso: complex, height: float, lean: float, yaw: float, feet: Mapping[Side, Placed]
) -> dict[Side, LegAngles]:
    upright = torso_rotation(yaw, lean).T
    bent: dict[Side, LegAngles] = {}
    for side, (pose, lifted) in feet.items():
        to = pose.place - torso
        ankle = upright @ np.array([to.real, to.imag, lifted + legs.foot - height])
        bent[side] = legs.bend(side, upright @ heading_rotation(pose.theta), ankle)
    return bent
