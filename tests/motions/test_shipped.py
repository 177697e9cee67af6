"""The four motions of the exhibition, as files: how long, inside limits and speeds, home again."""

from itertools import pairwise

import pytest

from lumen.errors import ProjectError, UsageError
from lumen.motion import Motion, beyond_limits, overspeed
from tests import ROOT
from tests.motions.making import SHIPPED, nao


def shipped(name: str) -> Motion:
    return Motion.load(ROOT / "motions" / f"{name}.yaml")


@pytest.mark.parametrize("name", SHIPPED)
def test_every_joint_keeps_its_limits(name: str) -> None:
    assert beyond_limits(shipped(name), nao()) == []


@pytest.mark.parametrize("name", SHIPPED)
def test_no_joint_is_asked_for_more_than_nine_tenths_of_its_speed(name: str) -> None:
    """A tenth is left for the approach from another pose and for the balance."""
    hurried = overspeed(shipped(name), nao())
    assert hurried == []
    motion = shipped(name)
    for track in motion._trajectory.tracks:
        assert max(s.peak_speed() for s in track.segments) <= 0.9 * nao().joints[track.joint].speed, track.joint


@pytest.mark.parametrize("name", SHIPPED)
def test_it_ends_in_stand(name: str) -> None:
    motion = shipped(name)
    stand = nao().postures["Stand"]
    assert (motion.start, motion.end) == ("Stand", "Stand")
    assert motion.sample(motion.duration) == pytest.approx({joint: stand[joint] for joint in motion.tracks}, abs=1e-3)


@pytest.mark.parametrize("name", SHIPPED)
def test_the_soles_stay_flat(name: str) -> None:
    """Hip, knee and ankle pitch of a leg add up alike in both legs, but for how far the torso leans in the motion."""
    motion = shipped(name)
    for i in range(200):
        pose = {**nao().postures["Stand"], **motion.sample(motion.duration * i / 199)}
        left, right = (pose[f"{s}HipPitch"] + pose[f"{s}KneePitch"] + pose[f"{s}AnklePitch"] for s in "LR")
        assert left == pytest.approx(right, abs=0.09)


def test_durations() -> None:
    assert shipped("goodbye").duration == pytest.approx(4.5)
    assert shipped("dance").duration >= 13.0
    assert shipped("sing").duration == pytest.approx(42.0)
    assert 11.0 <= shipped("photo").duration <= 14.0


def test_the_photo_s_pose_is_held_for_ten_seconds_and_breathes() -> None:
    photo = shipped("photo")
    assert photo.sample(1.5) == pytest.approx(photo.sample(11.4), abs=0.02)
    held = [photo.sample(1.4 + 0.1 * i) for i in range(101)]
    for pose in held:
        arms = {joint: angle for joint, angle in pose.items() if joint != "RHand"}
        assert arms == pytest.approx({joint: held[-1][joint] for joint in arms}, abs=0.05)
    for before, after in pairwise(held[::10]):
        assert max(abs(after[joint] - before[joint]) for joint in after if joint != "RHand") > 0.003


def test_the_song_has_nine_waves_after_its_lead_in() -> None:
    """A wave is a time at which the left upper arm stands highest."""
    raised = [key for key in shipped("sing").tracks["LShoulderPitch"] if key.angle < -0.5]
    assert len(raised) == 9
    assert 15.0 <= raised[0].time <= 17.0


def test_the_dance_bends_the_knees_on_every_beat_of_its_tempo() -> None:
    beat = 60 / 132
    low = [key.time / beat for key in shipped("dance").tracks["LKneePitch"] if key.angle > 0.9]
    assert low == pytest.approx([round(b) for b in low], abs=1e-6)
    assert [round(b) for b in low] == [*range(3, 31), 34, 40]  # the last two to lift a foot, and to put it down


def test_a_motion_for_the_head_leaves_it_to_the_visitor() -> None:
    """A robot that waves or poses keeps looking at whoever it is for."""
    for name in ("goodbye", "photo"):
        assert not {"HeadYaw", "HeadPitch"} & shipped(name).tracks.keys()


def test_a_dict_makes_a_motion_too() -> None:
    motion = Motion.from_dict({"keyframes": [{"at": "1s", "joints": {"HeadYaw": 0.5}}]})
    assert isinstance(motion, Motion)
    assert motion.sample(1.0) == {"HeadYaw": 0.5}
    assert motion.sample(0.0) == {"HeadYaw": 0.0}
    assert motion.sample(0.0, {"HeadYaw": -0.2}) == {"HeadYaw": -0.2}
    assert Motion.from_dict({"keyframes": [{"at": "1s", "play": "goodbye"}]}).duration == pytest.approx(5.5)


def test_what_can_t_be_loaded_says_why(tmp_path: object) -> None:
    with pytest.raises(ProjectError, match="unknown-joint"):
        Motion.from_dict({"keyframes": [{"at": "1s", "joints": {"Tail": 0.5}}]})
    with pytest.raises(UsageError, match="can't read"):
        Motion.load(ROOT / "motions" / "nothing.yaml")
