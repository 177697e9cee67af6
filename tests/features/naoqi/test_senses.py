"""Each sense of the robot, its faults, and that a fault in one affects no other."""

import logging

import numpy as np
import pytest

from lumen.features.naoqi.hardware import FORCE_SENSORS, INERTIAL, device
from lumen.language.commands import Posture
from lumen.language.routes import Size
from lumen.ports import Battery, Image, Joints, Sense, Tactile
from tests.features.naoqi.conftest import Live
from tests.features.naoqi.lockstep import Lockstep
from tests.waiting import until


def image(robot: Lockstep) -> Image:
    found = robot.read(Sense.IMAGE)
    assert isinstance(found, Image)
    return found


@pytest.mark.slow
def test_an_image_is_rgb_and_dated_by_our_clock(robot: Lockstep, live: Live) -> None:
    live(1.0)
    found = image(robot)
    assert found.pixels().shape == (240, 320, 3)
    assert np.unique(found.pixels().reshape(-1, 3), axis=0).tolist() == [[0, 128, 255]]
    assert found.time == pytest.approx(1.0, abs=0.03)


def test_what_an_earlier_run_left_is_let_go(robot: Lockstep) -> None:
    until(lambda: "lumen_7" not in robot.nao.camera.handles)
    assert "other_0" in robot.nao.camera.handles


def test_a_camera_that_somebody_unsubscribed_is_subscribed_again(
    robot: Lockstep, caplog: pytest.LogCaptureFixture
) -> None:
    image(robot)
    with caplog.at_level(logging.WARNING):
        robot.nao.camera.handles = []
        until(lambda: "sense `image` is not available" in caplog.text)
        assert isinstance(robot.read(Sense.JOINT), Joints)
        image(robot)
    lines = [record.getMessage() for record in caplog.records]
    assert len(lines) == 2
    assert "sense `image` is not available" in lines[0]
    assert lines[1] == "the sense `image` is back"


def test_an_image_of_another_size_is_none(robot: Lockstep, caplog: pytest.LogCaptureFixture) -> None:
    with caplog.at_level(logging.WARNING):
        robot.nao.world.size = (160, 120)
        assert robot.read(Sense.IMAGE) is None
        assert robot.read(Sense.IMAGE) is None
    assert sum("160 x 120 x 3, not of 320 x 240 x 3" in record.getMessage() for record in caplog.records) == 1


def test_images_of_the_size_that_is_wanted_come_after_the_next(robot: Lockstep) -> None:
    assert image(robot).pixels(Size(640, 480)).shape == (240, 320, 3)
    assert image(robot).pixels(Size(640, 480)).shape == (480, 640, 3)
    assert image(robot).pixels().shape == (480, 640, 3)
    assert image(robot).pixels().shape == (240, 320, 3)
    until(lambda: sum(name.startswith("lumen") for name in robot.nao.camera.handles) == 1)


def test_a_bumper_has_two_sides(robot: Lockstep) -> None:
    robot.nao.world.pressed = {"LeftBumper"}
    found = robot.read(Sense.TACTILE)
    assert isinstance(found, Tactile)
    assert dict(zip(found.names, found.values, strict=True))["LeftBumper"] == 1
    assert sum(found.values) == 1


def test_a_touch_whose_event_got_lost_is_felt(robot: Lockstep, live: Live) -> None:
    robot.nao.world.pressed = {"RearTactil"}
    robot.advance(1.0)
    robot.read(Sense.TACTILE)
    assert [(e.name, e.data) for e in live(0.1)] == [("touched", {"sensor": "RearTactil"})]


def test_a_low_battery_is_told_once(robot: Lockstep, live: Live) -> None:
    robot.nao.world.charge, robot.nao.world.charging = 0.19, True
    battery = robot.read(Sense.BATTERY)
    assert battery == Battery(battery.time, 19, plugged=True, charging=True)  # type: ignore[union-attr]
    assert [(e.name, e.data) for e in live(1.0)] == [("battery.low", {"percentage": 19})]


def test_a_hot_motor_is_told_once(robot: Lockstep, live: Live) -> None:
    live(1.0)
    robot.nao.world.temperatures = {"LKneePitch": 81.25}
    robot.read(Sense.JOINT)
    events = live(2.0)
    assert [(e.name, e.data) for e in events] == [("motors.hot", {"joint": "LKneePitch", "temperature": 81.2})]


def test_senses_go_on_while_a_command_blocks(robot: Lockstep, live: Live) -> None:
    robot.start("a", Posture("Crouch"))
    knees = []
    for _ in range(4):
        live(0.4)
        joints = robot.read(Sense.JOINT)
        assert isinstance(joints, Joints)
        knees.append(joints.angles[joints.names.index("LKneePitch")])
    assert knees == sorted(knees)
    assert knees[0] < knees[-1] - 0.5


def test_what_it_feels_travels_with_its_joints(robot: Lockstep) -> None:
    robot.nao.world.temperatures = {"LHipYawPitch": 51.5}
    robot.nao.world.lacks = {device("InertialSensor/AngleZ")}
    joints = robot.read(Sense.JOINT)
    assert isinstance(joints, Joints)
    heat = dict(zip(joints.names, joints.temperature, strict=True))
    assert (heat["LHipYawPitch"], heat["RHipYawPitch"], heat["HeadYaw"]) == (51.5, 51.5, 40.0)
    assert joints.inertial == {**dict.fromkeys(set(INERTIAL) - {"AngleZ"}, 0.0), "AccelerometerZ": 9.81}
    assert joints.fsr["LFoot/FSR/TotalWeight"] == 2.7
    assert joints.fsr.keys() == set(FORCE_SENSORS)


def test_a_robot_that_feels_nothing_has_its_joints_all_the_same(
    robot: Lockstep, caplog: pytest.LogCaptureFixture
) -> None:
    robot.nao.world.silent = {device("InertialSensor/AngleX")}
    with caplog.at_level(logging.WARNING):
        for _ in range(3):
            joints = robot.read(Sense.JOINT)
    assert isinstance(joints, Joints)
    assert len(joints.angles) == 26
    assert (joints.temperature, joints.inertial, joints.fsr) == ((), {}, {})
    lines = [record.getMessage() for record in caplog.records]
    assert lines == [
        (
            "the robot does not report its temperatures, its balance and the weight on its feet: "
            "ALMemory::getListData no such key"
        )
    ]


def test_a_full_battery_is_told_when_naoqi_tells(robot: Lockstep, live: Live) -> None:
    for flag in (1, 0, 1):
        robot.nao.tell("BatteryFullChargedFlagChanged", flag)
        robot.settle()
    assert [(e.name, e.data) for e in live(0.1)] == [("battery.full", {"percentage": 100})] * 2
