"""Ways of joints that all robots share: their durations, their goals, and how a motion begins."""

from dataclasses import replace
from math import inf

import pytest

import lumen
from lumen.errors import BadCommandError
from lumen.language.body_parts import ARMS, HEAD, LEGS
from lumen.language.motions import Cue, Keyframe, MotionDefinition
from lumen.motion.trajectories import Trajectory
from lumen.project.chosen_model import MODEL_VARIABLE
from lumen.robot.joint_ways import away, begun_from, home_angles, way_duration
from tests import ROOT

NAO = lumen.load(ROOT).body
NOD = MotionDefinition("nod", 1.0, {"HeadYaw": (Keyframe(0.2, 2.0), Keyframe(1.0, 0.0))}, (Cue(0.2, "say", "now"),))


def test_a_way_takes_as_long_as_its_slowest_joint_needs() -> None:
    speed = NAO.joints["HeadYaw"].speed
    assert way_duration({}, NAO, 0.8) == 0.8
    assert way_duration({"HeadYaw": 0.1, "HeadPitch": -0.1}, NAO, 0.8) == 0.8
    assert way_duration({"HeadYaw": -speed, "HeadPitch": 0.1}, NAO, 0.8) == pytest.approx(1.5 / 0.8)
    endless = replace(NAO, joints={**NAO.joints, "HeadYaw": replace(NAO.joints["HeadYaw"], speed=inf)})
    assert way_duration({"HeadYaw": 3.0}, endless, 0.8) == 0.8


def test_home_is_the_start_posture_of_the_parts_that_a_motion_owns() -> None:
    motion = replace(NOD, start="Crouch")
    assert home_angles(NOD, NAO, {HEAD, ARMS, LEGS}) == {}
    assert home_angles(motion, NAO, {ARMS, LEGS}).keys() == {*NAO.parts[ARMS], *NAO.parts[LEGS]}
    assert home_angles(motion, NAO, {HEAD}) == {name: NAO.postures["Crouch"][name] for name in NAO.parts[HEAD]}


@pytest.mark.parametrize("model", ["nao", "sprout"])
def test_a_leg_is_away_whatever_its_joints_are_called(model: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(MODEL_VARIABLE, model)
    body = lumen.load(ROOT).body
    stand, crouch = body.postures["Stand"], body.postures["Crouch"]
    assert away(crouch, stand, body, 0.05)
    assert not away(stand, stand, body, 0.05)
    arm = body.parts[ARMS][0]
    assert not away(stand, {**stand, arm: stand[arm] + 1.0}, body, 0.05)


def test_a_motion_that_begins_in_time_is_unchanged() -> None:
    assert begun_from(NOD, NAO, {"HeadYaw": 1.5}) is NOD


def test_a_motion_begins_later_if_its_first_key_is_too_soon() -> None:
    begun = begun_from(NOD, NAO, {"HeadYaw": -2.0})
    [way] = Trajectory(begun, {"HeadYaw": -2.0}).tracks
    assert way.segments[0].peak_speed() == pytest.approx(0.8 * NAO.joints["HeadYaw"].speed, rel=1e-3)
    assert begun.cues[0].time == way.ends[0] > 0.2
    assert begun.duration - way.ends[0] == pytest.approx(NOD.duration - 0.2)


def test_a_second_key_that_is_too_soon_is_refused() -> None:
    with pytest.raises(BadCommandError, match="`nod` turns HeadYaw at"):
        begun_from(replace(NOD, tracks={"HeadYaw": (Keyframe(0.5, 2.0), Keyframe(0.55, 0.0))}), NAO, {"HeadYaw": 2.0})
