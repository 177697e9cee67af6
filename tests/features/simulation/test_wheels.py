"""A robot on wheels: it drives to places, brakes, tracks its position, and tips over if it is pushed hard enough."""

import shutil
from dataclasses import replace
from math import hypot, pi
from pathlib import Path

import numpy as np
import pytest

from lumen.errors import RobotModelError
from lumen.features.simulation.offers import SimulatedRobot
from lumen.features.simulation.settings import PERFECT
from lumen.features.simulation.wheels import Wheels
from lumen.language.commands import Look, Move, Posture, Rest, Stop, Wake, Walk
from lumen.language.projects import Stage
from lumen.language.roles import Base
from lumen.motion.gait import Pose
from lumen.motion.gait.poses import wrap
from lumen.ports import Joints, Sense
from tests.features.simulation.bodies import shipped, standing
from tests.features.simulation.conftest import MODELS, answer, until_answered
from tests.features.simulation.walks import START

PLACES = (Walk(0.5), Walk(0.0, 0.3), Walk(-0.3), Walk(0.4, -0.3, pi / 2), Walk(0.0, 0.0, -2.0), Walk(-0.8, 0.4, 1.0))


@pytest.fixture
def greeter() -> SimulatedRobot:
    robot = standing("greeter")
    robot.advance(0.3)
    return robot


def wheels(robot: SimulatedRobot) -> Wheels:
    assert isinstance(robot.base, Wheels)
    return robot.base


def really(robot: SimulatedRobot) -> Pose:
    """Return the true pose of the robot, relative to its start [m, m, rad]."""
    torso = robot.world.data.body(robot.world.torso)
    axes = torso.xmat.reshape(3, 3)
    return Pose(torso.xpos[0] - START[0], torso.xpos[1] - START[1], np.arctan2(axes[1, 0], axes[0, 0]))


def drive(robot: SimulatedRobot, command: Walk) -> str:
    robot.start("x", command)
    return answer(until_answered(robot, "x"), "x")


def pushed(robot: SimulatedRobot, newton_seconds: float, to: float) -> None:
    """Push the torso's centre for 0.1 s towards `to` [rad]."""
    force = robot.world.data.xfrc_applied[robot.world.torso]
    force[:2] = 10 * newton_seconds * np.cos(to), 10 * newton_seconds * np.sin(to)
    force[3:5] = -0.5 * force[1], 0.5 * force[0]
    robot.advance(0.1)
    force[:] = 0.0


@pytest.mark.parametrize("command", PLACES, ids=str)
def test_it_drives_to_a_place_and_knows_that_it_is_there(command: Walk, greeter: SimulatedRobot) -> None:
    assert drive(greeter, command) == "done"
    here, believed = really(greeter), greeter.base.whereabouts
    assert believed
    assert hypot(here.x - command.x, here.y - command.y) < 0.03
    assert abs(wrap(here.theta - command.theta)) < 0.06
    assert hypot(here.x - believed.x, here.y - believed.y) < 0.02
    assert abs(wrap(here.theta - believed.theta)) < 0.03
    assert greeter.greatest_tilt < 2.0


def test_it_moves_at_a_speed_and_a_stop_brakes(greeter: SimulatedRobot) -> None:
    greeter.start("go", Move(0.4, 0.0, 0.0))
    greeter.advance(2.0)
    before = really(greeter)
    greeter.advance(1.0)
    assert really(greeter).seen_from(before).x == pytest.approx(0.4, rel=0.1)
    greeter.start("stop", Stop())
    greeter.advance(1.2)
    before = really(greeter)
    greeter.advance(1.0)
    assert abs(really(greeter).place - before.place) < 0.002


def test_it_turns_as_it_drives_on(greeter: SimulatedRobot) -> None:
    greeter.start("go", Move(0.2, 0.0, 0.5))
    greeter.advance(2.0)
    assert really(greeter).theta == pytest.approx(1.0, abs=0.2)
    greeter.start("on", Move(0.2, 0.0, -0.5))
    greeter.advance(2.0)
    assert abs(really(greeter).theta) < 0.3


def test_no_faster_than_its_base_and_no_sooner_than_it_can_bear(greeter: SimulatedRobot) -> None:
    base = wheels(greeter)
    greeter.start("go", Move(5.0, 0.0, 0.0))
    speeds = [base.drive.speed]
    for _ in range(300):
        greeter.advance(0.01)
        speeds.append(base.drive.speed)
    assert max(speeds) == pytest.approx(greeter.body.roles.base.speed)
    assert max(np.diff(speeds)) <= base.drive.geometry.acceleration * 0.01 + 1e-12
    assert not greeter.fallen


def test_wheels_do_not_go_aside(greeter: SimulatedRobot) -> None:
    greeter.start("go", Move(0.0, 0.2, 0.0))
    assert answer(until_answered(greeter, "go"), "go") == "error: a robot on wheels cannot drive sideways: turn first"


def test_it_stays_on_its_stage() -> None:
    robot = standing("greeter", stage=Stage((-0.5, 0.6), (-0.5, 0.5)))
    robot.advance(0.2)
    assert "the base would leave the stage: it would reach x = 0.99 m" in drive(robot, Walk(0.8))
    assert abs(really(robot).x) < 0.01
    robot.start("go", Move(0.5, 0.0, 0.0))
    reason = answer(until_answered(robot, "go"), "go")
    assert "the base would leave the stage" in reason
    assert 0.3 < really(robot).x < 0.6 - 0.19 + 0.02


def test_a_robot_that_is_held_says_so(greeter: SimulatedRobot) -> None:
    greeter.world.model.actuator_forcerange[wheels(greeter).drive.geometry.motors] = 0.0
    reason = drive(greeter, Walk(0.5))
    assert "the robot did not reach its target: it is 50 cm" in reason


def test_a_small_push_moves_it_a_hard_one_tips_it_over() -> None:
    for newton_seconds, falls in ((10.0, False), (150.0, True)):
        robot = standing("greeter")
        robot.advance(0.3)
        pushed(robot, newton_seconds, pi / 2)
        robot.advance(2.0)
        assert robot.fallen == falls
        assert any(event.name == "fallen" for event in robot.poll()) == falls


def test_what_has_fallen_does_not_drive() -> None:
    robot = standing("greeter")
    robot.advance(0.3)
    pushed(robot, 150.0, pi / 2)
    robot.advance(2.0)
    assert "fallen" in drive(robot, Walk(0.3))
    assert not robot.world.data.ctrl[wheels(robot).drive.geometry.motors].any()
    assert robot.base.whereabouts
    assert robot.base.whereabouts.doubt >= 0.6


def test_it_rests_where_it_stands_and_its_wheels_hold(greeter: SimulatedRobot) -> None:
    greeter.start("rest", Rest())
    assert answer(until_answered(greeter, "rest"), "rest") == "done"
    assert not greeter.awake
    before = really(greeter)
    greeter.advance(3.0)
    assert abs(really(greeter).place - before.place) < 0.005
    greeter.start("wake", Wake())
    assert answer(until_answered(greeter, "wake"), "wake") == "done"
    assert drive(greeter, Walk(0.2)) == "done"


def test_its_own_postures_and_its_head_move(greeter: SimulatedRobot) -> None:
    for id, command in (("posture", Posture("Welcome", 0.8)), ("look", Look(0.4, 0.2))):
        greeter.start(id, command)
        assert answer(until_answered(greeter, id), id) == "done"
    greeter.advance(0.5)
    angles = dict(zip(greeter.body.joints, greeter.world.angles, strict=True))
    assert angles["neck_turn"] == pytest.approx(0.4, abs=0.03)
    assert angles["left_elbow"] == pytest.approx(-1.1, abs=0.06)


def test_without_imperfections_only_what_its_wheels_slip_is_unknown() -> None:
    robot = standing("greeter", imperfections=PERFECT)
    robot.advance(0.3)
    assert drive(robot, Walk(1.0)) == "done"
    joints = robot.read(Sense.JOINT)
    assert isinstance(joints, Joints)
    assert joints.position
    assert joints.position.x == pytest.approx(1.0, abs=0.002)
    assert abs(joints.position.x - really(robot).x) < joints.position.doubt


UNFIT = {
    "an axle that points ahead": ('"left_wheel" class="wheel" axis="0 1 0"', "0 1 0", "1 0 0", "is not a hinge"),
    "a smaller wheel": (
        'name="right_tyre" class="touch" type="cylinder" size="0.09',
        "0.09",
        "0.07",
        "must have the same size",
    ),
    "no motor for speeds": ('<velocity name="left_wheel"', "velocity", "motor", "a velocity actuator for the wheel"),
}


@pytest.mark.parametrize("fault", UNFIT)
def test_wheels_that_it_can_not_drive_on_are_refused(fault: str, tmp_path: Path) -> None:
    line, old, new, reason = UNFIT[fault]
    models = Path(shutil.copytree(MODELS, tmp_path / "models"))
    text = (models / "greeter.xml").read_text()
    assert line in text
    (models / "greeter.xml").write_text(text.replace(line, line.replace(old, new)))
    with pytest.raises(RobotModelError, match=reason):
        SimulatedRobot(shipped("greeter"), models)


def test_wheels_that_are_not_named_are_missed() -> None:
    body = shipped("greeter")
    other = replace(body, roles=replace(body.roles, base=Base("wheels", "", "right_wheel", 0.5, 1.0)))
    with pytest.raises(RobotModelError, match=r"the role `base\.left`"):
        SimulatedRobot(other, MODELS)
