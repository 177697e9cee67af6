"""The foothold that catches a fall, and the leg that reaches it."""

from math import cos, sin

import numpy as np
import pytest

from lumen.motion.gait import FOUND, SIDES, LegGeometry, Side
from lumen.motion.gait.legs import sign
from lumen.motion.gait.swing import FARTHEST, HIP_STRETCHED, WIDEST_CATCH, hold_level, landing
from tests.gait.nao_legs import CLASSIC_LEGS, NAO_LEGS

OMEGA = 6.0
PACE = FOUND.catching
LEGS = pytest.mark.parametrize("legs", [NAO_LEGS, CLASSIC_LEGS], ids=["nao", "classic"])


@pytest.mark.parametrize("bears", SIDES)
def test_the_foot_lands_on_its_side_within_reach(bears: Side) -> None:
    draw = np.random.default_rng(1)
    for dcm in draw.uniform(-0.3, 0.3, (200, 2)):
        ahead, left = landing(NAO_LEGS, PACE, dcm, OMEGA, draw.uniform(0.0, 0.3), bears)
        assert abs(ahead) <= FARTHEST
        assert PACE.narrowest < -sign(bears) * left <= WIDEST_CATCH


def test_it_lands_farther_the_longer_the_body_falls() -> None:
    near, far = (landing(NAO_LEGS, PACE, np.array((0.11, 0.05)), OMEGA, left, "R")[0] for left in (0.05, 0.2))
    assert 0.0 < near < far
    assert landing(NAO_LEGS, PACE, np.array((-0.06, 0.05)), OMEGA, 0.1, "R")[0] < 0.0


def tilted(angle: float) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
    """Return the axes forward, left and up of a torso that leans forward by `angle` [rad]."""
    c, s = cos(angle), sin(angle)
    return np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])


@LEGS
@pytest.mark.parametrize("side", SIDES)
@pytest.mark.parametrize("lean", [-0.2, 0.0, 0.3])
@pytest.mark.parametrize("yaw", [-0.17, 0.0])
def test_the_sole_is_level_where_it_is_wanted(legs: LegGeometry, side: Side, lean: float, yaw: float) -> None:
    axes, place = tilted(lean), np.array((0.06, sign(side) * 0.06, -0.3))
    hip = legs.names[side][0]
    joints = hold_level(legs, side, axes, place, dict.fromkeys(legs.names[side], yaw))
    assert joints[hip] == pytest.approx(yaw, abs=1e-12)
    rotation, point = legs.sole(side, joints)
    assert axes @ point == pytest.approx(place, abs=2e-3)
    assert (axes @ rotation)[:, 2] == pytest.approx((0.0, 0.0, 1.0), abs=2e-3)


def test_no_thigh_goes_back_farther_than_it_can() -> None:
    start = dict.fromkeys(NAO_LEGS.names["L"], 0.0)
    joints = hold_level(NAO_LEGS, "L", tilted(-0.3), np.array((-0.2, 0.05, -0.3)), start)
    assert joints["LHipPitch"] == HIP_STRETCHED
    assert joints["LKneePitch"] > 0.5
