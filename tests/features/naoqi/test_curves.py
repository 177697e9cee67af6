"""NAOqi plays the curve that the motion describes, for every kind of interpolation."""

from math import pi

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lumen.features.naoqi.curves import MAX_CURVE_ERROR, curves
from lumen.language.motions import Interpolation, Keyframe, MotionDefinition
from lumen.language.projects import Project
from lumen.motion.trajectories import Trajectory
from tests.features.naoqi.joints import bezier


def worst(motion: MotionDefinition, start: dict[str, float]) -> float:
    """Return the largest distance between NAOqi's joints and the motion's, at every third cycle [rad]."""
    trajectory = Trajectory(motion, start)
    way = curves(trajectory.tracks)
    joints = {n: bezier(start[n], t, c) for n, t, c in zip(*way, strict=True)}
    cycles = range(1, int(motion.duration / 0.02) + 1)
    return max(abs(joints[n](i * 0.02) - a) for i in cycles[::3] for n, a in trajectory.sample(i * 0.02).items())


@pytest.mark.parametrize("name", ["goodbye", "dance", "sing", "photo"])
def test_the_shipped_motions_are_carried_over(project: Project, name: str) -> None:
    motion = project.motions[name]
    start = {joint: motion.origin.get(joint, keys[0].angle) for joint, keys in motion.tracks.items()}
    few = dict(list(motion.tracks.items())[::9])
    assert worst(MotionDefinition(name, motion.duration, few), start) < MAX_CURVE_ERROR


angles = st.floats(-pi / 2, pi / 2)
gaps = st.floats(0.4, 2.0)
handles = st.tuples(st.floats(0.01, 0.15), st.floats(-0.2, 0.2))


kinds = st.sampled_from(list(Interpolation))


@settings(max_examples=12)
@given(st.lists(st.tuples(gaps, angles, kinds, handles, handles), min_size=1, max_size=3), angles)
def test_any_motion_is_carried_over(rows: list[tuple], start: float) -> None:  # type: ignore[type-arg]
    time, keys = 0.0, []
    for gap, angle, kind, (dt_in, da_in), out in rows:
        time += gap
        keys.append(Keyframe(time, angle, kind, (-dt_in, da_in), out))
    found = worst(MotionDefinition("any", time, {"HeadYaw": tuple(keys)}), {"HeadYaw": start})
    assert found < MAX_CURVE_ERROR


def test_minimum_jerk_is_as_near_as_stated() -> None:
    motion = MotionDefinition("far", 2.0, {"HeadYaw": (Keyframe(2.0, 1.5, Interpolation.MINIMUM_JERK),)})
    assert 1e-5 < worst(motion, {"HeadYaw": -1.5}) < MAX_CURVE_ERROR


def test_a_line_is_one_piece_and_its_first_cycle() -> None:
    motion = MotionDefinition("line", 1.0, {"HeadYaw": (Keyframe(1.0, 0.5, Interpolation.LINEAR),)})
    way = curves(Trajectory(motion, {"HeadYaw": 0.0}).tracks)
    assert way.names == ["HeadYaw"]
    assert way.times[0] == pytest.approx([0.02, 1.0])
    assert [angle for angle, _, _ in way.controls[0]] == pytest.approx([0.01, 0.5])
