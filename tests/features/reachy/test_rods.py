"""The reach of Reachy Mini's head: its rods, and the body that follows."""

import json
from math import degrees, radians
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from lumen.features.reachy.following import FREE, limited, possible
from lumen.features.reachy.pose import BODY, HEAD, JOINTS, head_joints, target_message
from lumen.features.reachy.reach import worst_of
from lumen.features.reachy.rods import motor_angles, reaches, within_reach
from lumen.language.projects import Project
from tests.tables import for_each

RECORDED = json.loads((Path(__file__).parent / "recorded_motors.json").read_text())
"""Poses of the head, the body's angle, and the motors' angles by the solver of `reachy-mini` 1.13.0."""
LEVEL = dict.fromkeys(JOINTS, 0.0)
LENGTHS, ANGLES = st.floats(-0.05, 0.03), st.floats(-1.0, 1.0)
POSES = st.tuples(LENGTHS, LENGTHS, LENGTHS, ANGLES, ANGLES, ANGLES, ANGLES).map(
    lambda numbers: {**LEVEL, **dict(zip((*HEAD, BODY), numbers, strict=True))}
)


def test_the_motors_turn_as_the_vendors_solver_says() -> None:
    assert len(RECORDED) == 60
    for pose, motors in RECORDED:
        head = dict(zip(HEAD, pose, strict=False))
        assert (
            motor_angles(head, pose[6]) == pytest.approx(motors, abs=1e-3)
            if motors
            else None in motor_angles(head, pose[6])
        )


@for_each(
    ("pose", "reached"),
    [
        ({"head_z": 0.022}, True),
        ({"head_z": 0.026}, False),
        ({"head_pitch": radians(40)}, True),
        ({"head_pitch": radians(40), "head_z": 0.01}, False),
        ({"head_pitch": radians(30), "head_roll": radians(30), "head_z": 0.03}, False),
        ({"head_yaw": radians(64)}, True),
        ({"head_yaw": radians(66)}, False),
        ({"head_yaw": radians(100), BODY: radians(40)}, True),
        ({"head_x": -0.021, "head_z": -0.044, "head_pitch": radians(24.4)}, True),
    ],
)
def test_height_and_angles_share_what_the_rods_reach(pose: dict[str, float], reached: bool) -> None:
    assert reaches(LEVEL | pose, pose.get(BODY, 0.0)) is reached


@given(POSES)
def test_the_nearest_pose_is_within_reach_and_the_same_if_it_was(pose: dict[str, float]) -> None:
    pose = {**pose, "head_yaw": pose[BODY] + max(-1.1, min(1.1, pose["head_yaw"]))}
    near = within_reach(pose)
    assert reaches(near, near[BODY])
    assert near == pose or not reaches(pose, pose[BODY])
    assert near["head_yaw"] == pose["head_yaw"]


@given(POSES, st.floats(-3, 3))
def test_the_body_follows_before_its_cables_end(pose: dict[str, float], yaw: float) -> None:
    body = BODIES[0]
    found = possible({**pose, "head_yaw": yaw}, body)
    assert abs(found["head_yaw"] - found[BODY]) <= FREE + 1e-9
    assert all(body.joints[n].minimum <= found[n] <= body.joints[n].maximum for n in JOINTS)
    assert possible(found, body) == pytest.approx(found)


@given(POSES, POSES, st.floats(0.001, 0.1))
def test_no_joint_is_faster_than_it_may_be(goal: dict[str, float], last: dict[str, float], dt: float) -> None:
    body = BODIES[0]
    last = possible(last, body)
    found = limited(possible(goal, body), last, body, dt)
    assert reaches(found, found[BODY])
    if all(abs(found[n]) >= abs(last[n]) for n in HEAD):  # else the rods may have sent it back
        assert all(abs(found[n] - last[n]) <= body.joints[n].speed * dt + 1e-9 for n in JOINTS)


@given(POSES)
def test_a_pose_is_the_same_after_its_message(pose: dict[str, float]) -> None:
    message = target_message(pose)
    rows = [message["head"][i : i + 4] for i in range(0, 16, 4)]
    assert head_joints(rows) == pytest.approx({name: pose[name] for name in HEAD}, abs=1e-9)
    assert message["antennas"] == [pose["right_antenna"], pose["left_antenna"]]


BODIES: list = []  # type: ignore[type-arg]


@pytest.fixture(autouse=True)
def body(project: Project) -> None:
    BODIES[:] = [project.body]


def test_postures_and_shipped_motions_are_within_reach(project: Project) -> None:
    for name, posture in project.body.postures.items():
        assert possible(posture, project.body) == pytest.approx(posture, abs=1e-6), name
    for name, motion in project.motions.items():
        assert worst_of(motion, project.body) is None, name
    assert degrees(FREE) < 65
