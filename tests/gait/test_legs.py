"""Legs bend to reach given feet, and the positions of the feet follow from the joint angles."""

from math import pi

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lumen.language.robots import Body
from lumen.motion.gait import FOUND, SIDES, LegGeometry, Side, paces_of
from lumen.motion.gait.legs import Placed, other, sign, torso_rotation
from lumen.motion.gait.poses import Pose, wrap
from lumen.motion.gait.stance import stand
from tests.gait.nao_legs import CLASSIC_LEGS, NAO_LEGS
from tests.motions.making import nao
from tests.tables import for_each

side = st.sampled_from(SIDES)
turns = st.floats(-0.25, 0.25)
LEGS = pytest.mark.parametrize("legs", [NAO_LEGS, CLASSIC_LEGS], ids=["nao", "classic"])


@LEGS
@pytest.mark.slow
@given(
    side=side,
    yaw=turns,
    pitch=st.floats(-0.5, -0.2),
    roll=turns,
    knee=st.floats(0.2, 1.2),
    ankle=st.floats(-0.8, 0.0),
    tilt=turns,
)
def test_bending_a_leg_to_where_its_sole_is_gives_the_angles_back(
    legs: LegGeometry, side: Side, yaw: float, pitch: float, roll: float, knee: float, ankle: float, tilt: float
) -> None:
    angles = yaw, roll, pitch, knee, ankle, tilt
    joints = legs.joints(side, angles)
    assert legs.angles(side, joints) == pytest.approx(angles, abs=1e-12)
    rotation, place = legs.sole(side, joints)
    assert legs.bend(side, rotation, place + legs.foot * rotation[:, 2]) == pytest.approx(angles, abs=1e-6)


@LEGS
@pytest.mark.slow
@given(
    ahead=st.floats(-0.06, 0.06),
    apart=st.floats(0.09, 0.15),
    turned=turns,
    x=st.floats(-0.02, 0.02),
    y=st.floats(-0.03, 0.03),
    heading=turns,
)
def test_standing_on_two_feet_both_hips_agree_and_the_feet_are_where_they_should_be(
    legs: LegGeometry, ahead: float, apart: float, turned: float, x: float, y: float, heading: float
) -> None:
    left = Pose(0.3, -0.2, heading)
    right = left.then(Pose(ahead, -apart, turned))
    middle = left.toward(right, 0.5)
    torso = middle.place + complex(x, y) * middle.ahead
    stance = stand(legs, torso, 0.31, 0.05, heading, {"L": Placed(left), "R": Placed(right)})
    if legs.shared:
        assert stance.angles["LHipYawPitch"] == pytest.approx(stance.angles["RHipYawPitch"], abs=2e-4)
    else:
        assert stance.yaw == pytest.approx(middle.theta)
    seen = legs.foot_from("L", stance.angles)
    assert (seen.x, seen.y) == pytest.approx((ahead, -apart), abs=1e-5)
    assert wrap(seen.theta - turned) == pytest.approx(0.0, abs=1e-5)
    rotation, place = legs.sole("R", stance.angles)
    back = torso_rotation(stance.yaw, 0.05)
    assert (back @ place)[2] == pytest.approx(-0.31, abs=1e-5)
    assert (back @ rotation)[:, 2] == pytest.approx((0, 0, 1), abs=1e-5)


@LEGS
def test_a_foot_out_of_reach_is_approached(legs: LegGeometry) -> None:
    angles = legs.bend("L", np.eye(3), np.array([legs.hip_ahead, legs.hip_out, -1.0]))
    assert angles == pytest.approx((0, 0, 0, 0, 0, 0), abs=0.07)


def test_what_is_read_of_naos_legs_is_what_its_data_sheet_says() -> None:
    assert NAO_LEGS.hip(side="R") == (0.0, -0.05, -0.085)
    assert (NAO_LEGS.thigh, NAO_LEGS.tibia, NAO_LEGS.foot) == (0.1, 0.1029, 0.04511)
    assert NAO_LEGS.inclination == pi / 4
    assert NAO_LEGS.shared
    assert NAO_LEGS.sole_size == (0.095, 0.045, 0.046, 0.028)


def test_the_paces_were_found_with_naos_legs() -> None:
    assert paces_of(NAO_LEGS) == FOUND


def test_longer_legs_make_longer_and_slower_steps() -> None:
    usual = paces_of(CLASSIC_LEGS).usual
    assert usual.forward > FOUND.usual.forward
    assert usual.single > FOUND.usual.single
    assert usual.torso < 0.24 + 0.03 + CLASSIC_LEGS.hip_down


def test_what_is_kept_with_a_body_goes_before_the_rule() -> None:
    kept = paces_of(NAO_LEGS, {"usual": {"lean": 0.1, "forward": 0.05}, "brisk": {"single": 0.28}})
    assert (kept.usual.lean, kept.usual.forward, kept.usual.single) == (0.1, 0.05, FOUND.usual.single)
    assert (kept.brisk.lean, kept.brisk.forward, kept.brisk.single) == (0.1, FOUND.brisk.forward, 0.28)
    assert (kept.gentle.lean, kept.gentle.forward) == (0.1, FOUND.gentle.forward)


def test_what_is_known_of_the_legs_is_what_the_postures_say() -> None:
    body: Body = nao()
    feet = NAO_LEGS.foot_from("L", body.postures["StandZero"])
    assert feet == pytest.approx((0.0, -0.1, 0.0), abs=1e-9)
    assert {name for leg in SIDES for name in NAO_LEGS.names[leg]} == set(body.parts["legs"])


@for_each(("angle", "same"), [(pi, pi), (-pi, pi), (3 * pi, pi), (2 * pi + 0.1, 0.1), (-0.1, -0.1)])
def test_angles_are_wrapped(angle: float, same: float) -> None:
    assert wrap(angle) == pytest.approx(same)


def test_sides() -> None:
    assert [(other(leg), sign(leg)) for leg in SIDES] == [("R", 1), ("L", -1)]
