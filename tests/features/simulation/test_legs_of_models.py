"""The geometry read from a body's legs, and the legs that are refused with a reason."""

import shutil
from dataclasses import replace
from pathlib import Path

import pytest

from lumen.errors import RobotModelError
from lumen.features.simulation.falling_sense import MassModel
from lumen.features.simulation.leg_geometry import read_legs
from lumen.language.robots import Body
from lumen.motion.gait import FOUND, LegGeometry, paces_of
from tests.features.simulation.conftest import MODELS


@pytest.fixture(scope="module")
def models(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return Path(shutil.copytree(MODELS, tmp_path_factory.mktemp("project") / "models"))


def read(body: Body, models: Path, *edits: tuple[str, str]) -> LegGeometry:
    """Return the legs of the shipped robot, with these edits of its MJCF."""
    text = (models / "nao.xml").read_text()
    for old, new in edits:
        assert old in text
        text = text.replace(old, new)
    (models / "other.xml").write_text(text)
    other = replace(body, mjcf="other.xml")
    return read_legs(MassModel(other, models).model, other)


def test_another_tibia_makes_another_pace(body: Body, models: Path) -> None:
    legs = read(body, models, ('pos="0 0 -0.1029"', 'pos="0 0 -0.1529"'))
    assert legs.tibia == 0.1529
    assert paces_of(legs).usual.forward == pytest.approx(FOUND.usual.forward * 0.2529 / 0.2029, abs=1e-6)


def test_joints_that_count_the_other_way_are_noticed(body: Body, models: Path) -> None:
    ankle = 'name="LAnklePitch" class="leg" axis="0 1 0"'
    legs = read(body, models, (ankle, ankle.replace("0 1 0", "0 -1 0")))
    assert legs.signs["L"] == (-1.0, 1.0, 1.0, 1.0, -1.0, 1.0)
    assert legs.signs["R"] == (1.0, 1.0, 1.0, 1.0, 1.0, 1.0)


def test_hips_that_yaw_upright_are_read_as_such(body: Body, models: Path) -> None:
    upright = (("0 0.7071068 -0.7071068", "0 0 1"), ("0 0.7071068 0.7071068", "0 0 1"))
    legs = read(replace(body, shared={}), models, *upright)
    assert (legs.inclination, legs.shared) == (0.0, False)
    assert legs.signs["L"][0] == legs.signs["R"][0] == 1.0


def test_a_knee_that_is_bent_at_zero_is_allowed_for(body: Body, models: Path) -> None:
    bent = [
        (f'<body name="{side}KneePitch" pos="0 0 -0.1">', f'<body name="{side}KneePitch" pos="0.06 0 -0.08">')
        for side in "LR"
    ]
    legs = read(body, models, *bent)
    assert legs.thigh == pytest.approx(0.1)
    angles = legs.angles("L", dict.fromkeys(legs.names["L"], 0.0))
    assert angles[2] == pytest.approx(-0.6435, abs=1e-4)
    assert angles[3] == pytest.approx(0.6435, abs=1e-4)
    assert angles[4] == pytest.approx(0.0, abs=1e-9)


KNEE = '<joint name="{}KneePitch" class="leg" axis="0 1 0"'
ROLL = '<body name="{}HipPitch" pos="0 0 0">'
REFUSED = {
    "hip axes that pass each other": (
        [(ROLL.format(side), ROLL.format(side).replace("0 0 0", "0 0 -0.02")) for side in "LR"],
        "the axes of `LHipPitch` and `LHipRoll` are 20.0 mm apart: they must intersect",
    ),
    "a yaw axis beside the hip": (
        [(f'<body name="{side}HipRoll" pos="0 0 0">', f'<body name="{side}HipRoll" pos="0.01 0 0">') for side in "LR"],
        "the axes of `LHipYawPitch` and `LHipRoll` are 10.0 mm apart",
    ),
    "a knee that rolls": (
        [(KNEE.format("L"), KNEE.format("L").replace("0 1 0", "1 0 0"))],
        "the axis of `LKneePitch` does not point straight aside",
    ),
    "a sole beside its ankle": (
        [('<site name="LSole" pos="0 0 -0.04511"/>', '<site name="LSole" pos="0.03 0 -0.04511"/>')],
        "the site `LSole` is 30.0 mm ahead of the ankle",
    ),
    "a sole in the air": (
        [('<site name="LSole" pos="0 0 -0.04511"/>', '<site name="LSole" pos="0 0 -0.07"/>')],
        "no flat part of `LAnkleRoll` touches the ground at the site `LSole`",
    ),
}


@pytest.mark.parametrize("fault", REFUSED)
def test_legs_that_it_can_not_walk_on_are_refused(body: Body, models: Path, fault: str) -> None:
    edits, reason = REFUSED[fault]
    with pytest.raises(RobotModelError, match="the robot cannot walk on its legs: ") as raised:
        read(body, models, *edits)
    assert reason in str(raised.value)


def test_legs_that_differ_are_refused(body: Body, models: Path) -> None:
    left = '<joint name="LAnklePitch"'
    text = (models / "nao.xml").read_text()
    at = text.index('pos="0 0 -0.1029"')
    assert text.index(left) > at
    (models / "nao.xml").with_name("uneven.xml").write_text(text[:at] + 'pos="0 0 -0.1129"' + text[at + 17 :])
    other = replace(body, mjcf="uneven.xml")
    with pytest.raises(RobotModelError, match=r"the two shanks differ by 10\.0 mm"):
        read_legs(MassModel(other, models).model, other)


def test_five_joints_are_no_leg(body: Body, models: Path) -> None:
    right = {name: role for name, role in body.roles.legs["right"].items() if name != "ankle-roll"}
    other = replace(body, roles=replace(body.roles, legs={**body.roles.legs, "right": right}))
    with pytest.raises(RobotModelError, match="the right leg has no `ankle-roll`"):
        read_legs(MassModel(other, models).model, other)


def test_a_knee_that_bends_backwards_is_refused(body: Body, models: Path) -> None:
    knee = replace(body.joints["LKneePitch"], minimum=-2.1, maximum=0.1)
    other = replace(body, joints={**body.joints, "LKneePitch": knee})
    with pytest.raises(RobotModelError, match="`LKneePitch` bends backwards"):
        read_legs(MassModel(other, models).model, other)
