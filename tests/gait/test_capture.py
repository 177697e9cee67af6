"""Where a foot has to land to catch a fall, and the leg that brings it there."""

from math import cos, sin

import numpy as np
import pytest

from lumen.interpreters.gait import JOINTS, SIDES, Side
from lumen.interpreters.gait.capture import FARTHEST, HIP_STRETCHED, WIDEST_CATCH, hold_level, landing
from lumen.interpreters.gait.footsteps import NARROWEST
from lumen.interpreters.gait.legs import sign, sole

OMEGA = 6.0


@pytest.mark.parametrize("bears", SIDES)
def test_the_foot_lands_on_its_side_within_reach(bears: Side) -> None:
    draw = np.random.default_rng(1)
    for dcm in draw.uniform(-0.3, 0.3, (200, 2)):
        ahead, left = landing(dcm, OMEGA, draw.uniform(0.0, 0.3), bears)
        assert abs(ahead) <= FARTHEST
        assert NARROWEST < -sign(bears) * left <= WIDEST_CATCH


def test_it_lands_farther_the_longer_the_body_falls() -> None:
    near, far = (landing(np.array((0.11, 0.05)), OMEGA, left, "R")[0] for left in (0.05, 0.2))
    assert 0.0 < near < far
    assert landing(np.array((-0.06, 0.05)), OMEGA, 0.1, "R")[0] < 0.0


def tilted(angle: float) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
    """Forward, left and up in the frame of a torso that leans forward by that [rad]."""
    c, s = cos(angle), sin(angle)
    return np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])


@pytest.mark.parametrize("side", SIDES)
@pytest.mark.parametrize("lean", [-0.2, 0.0, 0.3])
@pytest.mark.parametrize("yaw", [-0.17, 0.0])
def test_the_sole_is_level_where_it_is_wanted(side: Side, lean: float, yaw: float) -> None:
    axes, place = tilted(lean), np.array((0.06, sign(side) * 0.06, -0.3))
    joints = hold_level(side, axes, place, yaw)
    assert joints[0] == yaw
    rotation, point = sole(side, dict(zip((side + n for n in JOINTS), joints, strict=True)))
    assert axes @ point == pytest.approx(place, abs=2e-3)
    assert (axes @ rotation)[:, 2] == pytest.approx((0.0, 0.0, 1.0), abs=2e-3)


def test_no_thigh_goes_back_farther_than_it_can() -> None:
    joints = hold_level("L", tilted(-0.3), np.array((-0.2, 0.05, -0.3)), 0.0)
    assert joints[2] == HIP_STRETCHED
    assert joints[3] > 0.5
