"""The recording robot and life with bodies that are no NAO: reversed heads, none at all, wheels, no sensors."""

from dataclasses import replace

import pytest

from lumen.language.commands import Look, Walk
from lumen.language.robots import Joint
from lumen.language.roles import Base, JointRole, Roles
from lumen.language.stories import Visitor
from lumen.ports import Joints, Sense
from lumen.robot.recording import RecordingRobot
from tests.exhibits import BODY

JOINTS = {"Neck": Joint("Neck", -1.0, 1.0), "Nod": Joint("Nod", -0.5, 0.5)}
GREETER = replace(
    BODY,
    name="greeter",
    joints=JOINTS,
    parts={"head": ("Neck", "Nod"), "arms": (), "legs": ()},
    postures={"Stand": {"Neck": 0.0, "Nod": 0.0}},
    tactile=(),
    sonar=None,
    roles=Roles(
        head={"yaw": JointRole("Neck", reversed=True), "pitch": JointRole("Nod")},
        base=Base("wheels", "L", "R", 0.5, 1.0),
    ),
)
LAMP = replace(GREETER, name="lamp", camera=None, roles=Roles())


def after(robot: RecordingRobot, seconds: float) -> list[str]:
    for _ in range(round(seconds / 0.02)):
        robot.advance(0.02)
    return [event.name for event in robot.poll()]


def test_it_looks_with_the_joints_that_have_the_roles() -> None:
    robot = RecordingRobot(GREETER)
    robot.start("1", Look(0.4, 0.2))
    assert after(robot, 2) == ["done.command.1"]
    joints = robot.read(Sense.JOINT)
    assert isinstance(joints, Joints)
    assert dict(zip(joints.names, joints.angles, strict=True)) == {"Neck": -0.4, "Nod": 0.2}


def test_a_face_to_the_left_comes_to_the_middle_when_the_head_turns_left() -> None:
    robot = RecordingRobot(GREETER)
    robot.place(Visitor(1.5, 0.4, 1.6))
    before = robot.face()
    robot.start("1", Look(0.26, 0.0))
    after(robot, 2)
    seen = robot.face()
    assert before is not None
    assert seen is not None
    assert abs(seen[0] - 160) < abs(before[0] - 160)


def test_wheels_walk_and_the_odometry_says_where_to() -> None:
    robot = RecordingRobot(GREETER)
    robot.start("1", Walk(0.5, 0.0, 0.0))
    assert after(robot, 10) == ["done.command.1"]
    joints = robot.read(Sense.JOINT)
    assert isinstance(joints, Joints)
    assert joints.position is not None
    assert joints.position.x == pytest.approx(0.5)


def test_what_a_body_lacks_reads_nothing_and_fails_in_words() -> None:
    robot = RecordingRobot(LAMP)
    assert robot.read(Sense.SONAR) is None
    assert robot.read(Sense.TACTILE) is None
    robot.place(Visitor(1.0, 0.0, 1.6))
    assert robot.face() is None
    robot.sound()
    robot.start("1", Walk(0.1))
    robot.advance(0.02)
    (answer,) = robot.poll()
    assert answer.name == "error.command.1"
    assert answer.data == {"reason": "`walk`: lamp has neither legs nor wheels"}
