"""Legs bend to where the feet are, and tell where the feet are from how they are bent."""

from math import pi

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lumen.interpreters.gait.legs import (
    JOINTS,
    SIDES,
    Placed,
    Side,
    bend,
    foot_from,
    other,
    sign,
    sole,
    stand,
    torso_rotation,
)
from lumen.interpreters.gait.poses import Pose, wrap
from lumen.language.robots import Body
from tests.motions.making import nao

side = st.sampled_from(SIDES)
turns = st.floats(-0.25, 0.25)


@pytest.mark.slow
@given(side, turns, st.floats(-0.5, -0.2), turns, st.floats(0.2, 1.2), st.floats(-0.8, 0.0), turns)
def test_bending_a_leg_to_where_its_sole_is_gives_the_angles_back(
    leg: Side, yaw: float, pitch: float, roll: float, knee: float, ankle: float, tilt: float
) -> None:
    angles = dict(zip((leg + name for name in JOINTS), (yaw, roll, pitch, knee, ankle, tilt), strict=True))
    rotation, place = sole(leg, angles)
    assert bend(leg, rotation, place + 0.04511 * rotation[:, 2]) == pytest.approx(tuple(angles.values()), abs=1e-6)


@pytest.mark.slow
@given(st.floats(-0.06, 0.06), st.floats(0.09, 0.15), turns, st.floats(-0.02, 0.02), st.floats(-0.03, 0.03), turns)
def test_standing_on_two_feet_both_hips_agree_and_the_feet_are_where_they_should_be(
    ahead: float, apart: float, turned: float, x: float, y: float, heading: float
) -> None:
    left = Pose(0.3, -0.2, heading)
    right = left.then(Pose(ahead, -apart, turned))
    middle = left.toward(right, 0.5)
    torso = middle.place + complex(x, y) * middle.ahead
    stance = stand(torso, 0.31, 0.05, heading, {"L": Placed(left), "R": Placed(right)})
    assert stance.angles["LHipYawPitch"] == pytest.approx(stance.angles["RHipYawPitch"], abs=2e-4)
    seen = foot_from("L", stance.angles)
    assert (seen.x, seen.y) == pytest.approx((ahead, -apart), abs=1e-5)
    assert wrap(seen.theta - turned) == pytest.approx(0.0, abs=1e-5)
    rotation, place = sole("R", stance.angles)
    back = torso_rotation(stance.yaw, 0.05)
    assert (back @ place)[2] == pytest.approx(-0.31, abs=1e-5)
    assert (back @ rotation)[:, 2] == pytest.approx((0, 0, 1), abs=1e-5)


def test_a_foot_out_of_reach_is_approached() -> None:
    angles = bend("L", np.eye(3), np.array([0.0, 0.05, -1.0]))
    assert angles == pytest.approx((0, 0, 0, 0, 0, 0), abs=0.07)


def test_what_is_known_of_the_legs_is_what_the_postures_say() -> None:
    body: Body = nao()
    feet = foot_from("L", body.postures["StandZero"])
    assert feet == pytest.approx((0.0, -0.1, 0.0), abs=1e-9)
    assert {leg + name for leg in SIDES for name in JOINTS} == set(body.parts["legs"])


@pytest.mark.parametrize(("angle", "same"), [(pi, pi), (-pi, pi), (3 * pi, pi), (2 * pi + 0.1, 0.1), (-0.1, -0.1)])
def test_angles_are_wrapped(angle: float, same: float) -> None:
    assert wrap(angle) == pytest.approx(same)


def test_sides() -> None:
    assert [(other(leg), sign(leg)) for leg in SIDES] == [("R", 1), ("L", -1)]
