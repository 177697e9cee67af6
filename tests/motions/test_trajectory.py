"""The path of a motion's joints: through every key, inside the limits, without a jump."""

from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from lumen.language.motions import Interpolation, Keyframe, MotionDefinition
from lumen.motion.limits import beyond_limits, overspeed
from lumen.motion.trajectories import Trajectory, sample
from tests.motions.making import motions, nao

BEZIER, LINEAR = Interpolation.BEZIER, Interpolation.LINEAR


def moments(motion: MotionDefinition, count: int = 200) -> list[float]:
    return [motion.duration * i / count for i in range(count + 1)]


@pytest.mark.slow
@given(motions())
def test_passes_through_its_keys(motion: MotionDefinition) -> None:
    trajectory = Trajectory(motion)
    for joint, keys in motion.tracks.items():
        for key in keys:
            assert trajectory.sample(key.time)[joint] == key.angle


@pytest.mark.slow
@given(motions(), st.floats(-0.5, 0.5))
def test_begins_where_the_robot_is(motion: MotionDefinition, angle: float) -> None:
    start = dict.fromkeys(motion.tracks, angle)
    assert sample(motion, 0.0, start) == start
    assert sample(motion, -1.0, start) == start


@pytest.mark.slow
@given(motions())
def test_stays_inside_the_limits_between_keys(motion: MotionDefinition) -> None:
    trajectory = Trajectory(motion)
    for t in moments(motion):
        for joint, angle in trajectory.sample(t).items():
            limits = nao().joints[joint]
            assert limits.minimum - 1e-9 <= angle <= limits.maximum + 1e-9


@pytest.mark.slow
@given(motions())
def test_never_leaves_the_range_of_neighbouring_keys(motion: MotionDefinition) -> None:
    """This holds for each interpolation that is drawn: only Bezier handles can lead beyond."""
    trajectory = Trajectory(motion)
    for joint, keys in motion.tracks.items():
        angles = [motion.origin[joint], *(key.angle for key in keys)]
        times = [0.0, *(key.time for key in keys)]
        for (a, b), (t0, t1) in zip(pairwise(angles), pairwise(times), strict=True):
            for i in range(21):
                angle = trajectory.sample(t0 + (t1 - t0) * i / 20)[joint]
                assert min(a, b) - 1e-9 <= angle <= max(a, b) + 1e-9


@pytest.mark.slow
@given(motions())
def test_never_jumps(motion: MotionDefinition) -> None:
    """Between two moments no joint goes farther than its peak speed allows."""
    trajectory = Trajectory(motion)
    peak = {track.joint: max(s.peak_speed() for s in track.segments) for track in trajectory.tracks}
    step = motion.duration / 200
    samples = [trajectory.sample(t) for t in moments(motion)]
    for before, after in pairwise(samples):
        for joint, speed in peak.items():
            assert abs(after[joint] - before[joint]) <= 1.05 * speed * step + 1e-9


@pytest.mark.slow
@given(motions((Interpolation.MINIMUM_JERK, Interpolation.CUBIC, BEZIER)))
def test_speed_has_no_jump_where_the_kind_is_one_kind(motion: MotionDefinition) -> None:
    """A smooth interpolation arrives at a key as fast as it leaves it."""
    eps = 1e-6
    for joint, keys in motion.tracks.items():
        kinds = {key.interpolation for key in keys}
        trajectory = Trajectory(motion)
        fastest = max(s.peak_speed() for t in trajectory.tracks if t.joint == joint for s in t.segments)
        for key in keys[:-1] if len(kinds) == 1 else ():
            at = [trajectory.sample(key.time + d)[joint] for d in (-eps, 0.0, eps)]
            assert abs((at[2] - at[1]) - (at[1] - at[0])) / eps <= 1e-3 * fastest + 1e-2


@pytest.mark.slow
@given(motions())
def test_what_it_says_of_speeds_is_what_samples_show(motion: MotionDefinition) -> None:
    """`overspeed` names a joint exactly if dense samples are too fast."""
    found = {e.joint for e in overspeed(motion, nao())}
    trajectory = Trajectory(motion)
    for track in trajectory.tracks:
        limit = nao().joints[track.joint].speed
        fastest = 0.0
        for segment in track.segments:
            times = [segment.start + segment.duration * i / 400 for i in range(401)]
            angles = [segment.at(t) for t in times]
            fastest = max(fastest, max(abs(b - a) for a, b in pairwise(angles)) * 400 / segment.duration)
        if fastest > limit * 1.01:
            assert track.joint in found
        if fastest < limit * 0.97:
            assert track.joint not in found


def test_a_bezier_handle_can_lead_beyond_the_limits_and_that_is_said() -> None:
    top = nao().joints["HeadYaw"].maximum
    key = Keyframe(1.0, top, BEZIER, handle_in=(-0.5, 1.5))
    motion = MotionDefinition("m", 1.0, {"HeadYaw": (key,)}, origin={"HeadYaw": 0.0})
    (excess,) = beyond_limits(motion, nao())
    assert (excess.joint, excess.key, excess.limit) == ("HeadYaw", key, top)
    assert excess.value > top + 0.1


def test_bezier_handles_shape_the_way_between_keys() -> None:
    """With both handles level and at half time the curve is S-shaped; in the middle it is half way."""
    keys = (Keyframe(1.0, 0.0, BEZIER, handle_out=(0.5, 0.0)), Keyframe(2.0, 1.0, BEZIER, handle_in=(-0.5, 0.0)))
    motion = MotionDefinition("m", 2.0, {"HeadYaw": keys}, origin={"HeadYaw": 0.0})
    assert sample(motion, 1.5)["HeadYaw"] == pytest.approx(0.5)
    assert sample(motion, 1.25)["HeadYaw"] < 0.25


@pytest.mark.slow
@given(st.floats(0.0, 5.0), st.floats(-2, 2), st.floats(0.0, 5.0), st.floats(-2, 2))
def test_any_handle_leaves_time_running_forward(out: float, up: float, inward: float, down: float) -> None:
    keys = (Keyframe(1.0, 0.0, BEZIER, handle_out=(out, up)), Keyframe(2.0, 1.0, BEZIER, handle_in=(-inward, down)))
    track = Trajectory(MotionDefinition("m", 2.0, {"HeadYaw": keys}, origin={"HeadYaw": 0.0})).tracks[0]
    angles = [track.at(1.0 + i / 100) for i in range(101)]
    assert angles[0] == pytest.approx(0.0, abs=1e-9)
    assert angles[-1] == pytest.approx(1.0, abs=1e-9)
    assert all(-2.5 <= a <= 3.5 for a in angles)


def test_coupled_limits_are_judged_by_where_the_other_joint_is() -> None:
    """Far to the side, the head can't be lowered as deep as in the middle."""
    tracks = {"HeadYaw": (Keyframe(1.0, 1.5, LINEAR),), "HeadPitch": (Keyframe(1.0, 0.45, LINEAR),)}
    (excess,) = beyond_limits(MotionDefinition("m", 1.0, tracks), nao())
    assert excess.joint == "HeadPitch"
    assert excess.limit == pytest.approx(0.2061, abs=1e-3)
    assert not beyond_limits(MotionDefinition("m", 1.0, {"HeadPitch": tracks["HeadPitch"]}), nao())


def test_without_a_start_a_joint_waits_at_its_first_key() -> None:
    motion = MotionDefinition("m", 2.0, {"HeadYaw": (Keyframe(1.0, 0.4), Keyframe(2.0, 0.0))})
    assert sample(motion, 0.3) == {"HeadYaw": 0.4}
