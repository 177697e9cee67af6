"""Motions made of motions."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from lumen.language.mirrors import mirror_of
from lumen.language.motions import Cue, Keyframe, MotionDefinition
from lumen.motion.choreography import at_speed, joined, mirrored, trailing
from lumen.motion.trajectories import Trajectory
from tests.motions.making import made, motions, nao

MIRROR = mirror_of(nao())


@given(motions())
def test_mirrored_twice_is_the_motion_itself(motion: MotionDefinition) -> None:
    assert mirrored(mirrored(motion, MIRROR), MIRROR) == motion


@pytest.mark.slow
@given(motions())
def test_a_mirrored_motion_moves_the_other_side(motion: MotionDefinition) -> None:
    there, here = Trajectory(mirrored(motion, MIRROR)).sample(0.7), Trajectory(motion).sample(0.7)
    for joint, angle in here.items():
        other, sign = MIRROR[joint]
        assert there[other] == pytest.approx(sign * angle)


@given(st.lists(st.integers(5, 500), min_size=1, max_size=8, unique=True), st.floats(0.01, 1.0))
def test_what_trails_comes_later_in_the_same_order_and_ends_with_the_rest(times: list[int], lag: float) -> None:
    keys = tuple(Keyframe(time / 100, 0.1) for time in sorted(times))
    motion = MotionDefinition("it", keys[-1].time, {"RWristYaw": keys, "RElbowRoll": keys})
    late = trailing(motion, {"RWristYaw": lag, "HeadYaw": lag})
    assert late.tracks["RElbowRoll"] == keys
    came = [key.time for key in late.tracks["RWristYaw"]]
    assert came == sorted(set(came))
    assert came[-1] == motion.duration
    assert all(0.0 <= new - key.time <= lag + 1e-9 for new, key in zip(came, keys, strict=True))


def test_mirroring_knows_which_joints_turn_the_other_way() -> None:
    assert MIRROR["LShoulderPitch"] == ("RShoulderPitch", 1.0)
    assert MIRROR["RElbowRoll"] == ("LElbowRoll", -1.0)
    assert MIRROR["HeadYaw"] == ("HeadYaw", -1.0)
    assert MIRROR["LHipYawPitch"] == ("RHipYawPitch", 1.0)
    assert MIRROR["LHand"] == ("RHand", 1.0)


def test_the_robot_s_limits_are_those_of_its_mirror_image() -> None:
    """All but the ankles' pitch, so that a mirrored motion fits wherever the motion does."""
    for name, joint in nao().joints.items():
        other, sign = MIRROR[name]
        image = sorted((sign * joint.minimum, sign * joint.maximum))
        assert image == pytest.approx([nao().joints[other].minimum, nao().joints[other].maximum], abs=0.01)


def test_lights_change_sides_too() -> None:
    motion = MotionDefinition(
        "m", 1.0, {}, (Cue(0.0, "leds", {"left_eye": "red", "eyes": "blue", "right_ear": "off"}),)
    )
    assert mirrored(motion, MIRROR).cues[0].value == {"right_eye": "red", "eyes": "blue", "left_ear": "off"}


@given(motions(), st.floats(0.2, 5.0), st.floats(0.0, 1.0))
def test_speed_changes_when_and_not_where(motion: MotionDefinition, speed: float, part: float) -> None:
    t, faster = part * motion.duration, at_speed(motion, speed)
    assert faster.duration == pytest.approx(motion.duration / speed)
    assert Trajectory(faster).sample(t / speed) == pytest.approx(Trajectory(motion).sample(t), abs=1e-6)


@pytest.mark.slow
@given(motions())
def test_joined_motions_follow_one_another(motion: MotionDefinition) -> None:
    twice = joined([(0.0, motion), (motion.duration, motion)], 2 * motion.duration)
    for joint, keys in motion.tracks.items():
        assert [key.angle for key in twice.tracks[joint]] == 2 * [key.angle for key in keys]
        assert twice.tracks[joint][-1].time == pytest.approx(motion.duration + keys[-1].time)


BLOCK = """
units: {angle: deg}
tempo: 120
end: null
keyframes:
  - {beat: 1, joints: {RElbowRoll: 20}, leds: {right_eye: red}}
  - repeat: 4
    mirror: alternate
    speed: 2
    keyframes:
      - {beat: 1, joints: {RElbowRoll: 40}}
      - {beat: 2, joints: {RElbowRoll: 20}}
  - {beat: 6, joints: {RElbowRoll: 30}}
"""


def test_a_block_is_played_as_often_as_fast_and_on_the_side_it_says() -> None:
    motion = made(BLOCK)
    assert motion.duration == pytest.approx(3.0)
    assert [key.time for key in motion.tracks["RElbowRoll"]] == pytest.approx([0.5, 0.75, 1.0, 1.75, 2.0, 3.0])
    assert [key.time for key in motion.tracks["LElbowRoll"]] == pytest.approx([1.25, 1.5, 2.25, 2.5])
    assert motion.tracks["LElbowRoll"][0].angle == pytest.approx(-0.6981, abs=1e-4)


def test_a_motion_plays_another_one() -> None:
    nod = made("{end: null, keyframes: [{at: 1s, joints: {HeadPitch: 0.2}, say: Yes}]}")
    twice = made(
        "keyframes: [{at: 500ms, play: nod, repeat: 2, speed: 2}, {at: 2s, joints: {HeadPitch: -0.17}}]", nod=nod
    )
    assert [key.time for key in twice.tracks["HeadPitch"]] == pytest.approx([1.0, 1.5, 2.0])
    assert [(cue.time, cue.kind, cue.value) for cue in twice.cues] == [(1.0, "say", "Yes"), (1.5, "say", "Yes")]
    assert {key.where for key in twice.tracks["HeadPitch"][:2]} == {("keyframes", 0, "play")}


def test_a_motion_returns_to_where_it_began() -> None:
    motion = made("{return: 700ms, keyframes: [{at: 1s, joints: {HeadPitch: 0.2, HeadYaw: 0}}]}")
    assert motion.duration == pytest.approx(1.7)
    assert Trajectory(motion).sample(motion.duration)["HeadPitch"] == nao().postures["Stand"]["HeadPitch"]
    assert len(motion.tracks["HeadYaw"]) == 1, "it stands there already"


def test_a_motion_can_end_elsewhere_or_stay() -> None:
    there = made("{end: StandInit, keyframes: [{at: 1s, posture: StandZero}]}")
    assert Trajectory(there).sample(9.0) == pytest.approx(nao().postures["StandInit"])
    stays = made("{end: null, keyframes: [{at: 1s, posture: StandZero}]}")
    assert stays.duration == 1.0
    assert stays.end == ""


def test_poses_build_on_one_another_and_what_stands_nearer_wins() -> None:
    motion = made(
        """
        end: null
        poses:
          low: {joints: {RElbowRoll: 0.3, RShoulderPitch: 1}}
          high: {pose: low, joints: {RShoulderPitch: -1}, hands: {right: 1}}
          other: {pose: high, mirror: true}
        keyframes:
          - {at: 1s, pose: [high, other], joints: {RElbowRoll: 0.5}}
        """
    )
    assert {joint: keys[0].angle for joint, keys in motion.tracks.items()} == {
        "RElbowRoll": 0.5, "RShoulderPitch": -1, "RHand": 1, "LElbowRoll": -0.3, "LShoulderPitch": -1, "LHand": 1,
    }  # fmt: skip


def test_what_one_shared_motor_is_told_holds_for_both_joints() -> None:
    motion = made("{end: null, keyframes: [{at: 1s, posture: Stand, joints: {RHipYawPitch: -0.1}}]}")
    assert motion.tracks["LHipYawPitch"][0].angle == motion.tracks["RHipYawPitch"][0].angle == -0.1


def test_handles_are_read_in_the_file_s_units() -> None:
    motion = made(
        """
        units: {angle: deg}
        keyframes:
          - at: 1s
            joints: {HeadYaw: 10}
            interpolation: bezier
            handles: {HeadYaw: {in: {before: 200ms, angle: -90}, out: {after: 100ms, angle: 18}}}
        """
    )
    key = motion.tracks["HeadYaw"][0]
    assert key.handle_in == pytest.approx((-0.2, -1.5708), abs=1e-4)
    assert key.handle_out == pytest.approx((0.1, 0.3142), abs=1e-4)
