"""Pepper behind the same bridge: NAOqi's calls for a robot on wheels. The fake Pepper was written from memory."""

import logging
from dataclasses import replace

import pytest

import lumen
from lumen.language.commands import Leds, Look, Posture, Rest, Say, Wake, Walk
from lumen.language.gestures import merged
from lumen.language.motions import Cue, MotionDefinition
from lumen.language.projects import Project
from lumen.ports import Joints, Live, Perform, Sense, Sonar, Tactile
from lumen.project.chosen_model import MODEL_VARIABLE
from tests import ROOT
from tests.features.naoqi.conftest import Live as LiveFor
from tests.features.naoqi.fake import FakeNao
from tests.features.naoqi.lockstep import Lockstep
from tests.features.naoqi.test_commands import answers, reason


@pytest.fixture(scope="module")
def project() -> Project:
    """The shipped exhibition, performed by Pepper."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv(MODEL_VARIABLE, "pepper")
        return lumen.load(ROOT)


def test_nothing_is_missed_of_it_and_no_reflex_left_off(project: Project, caplog: pytest.LogCaptureFixture) -> None:
    with caplog.at_level(logging.WARNING):
        robot = Lockstep(project)
        for sense in Sense:
            assert robot.read(sense) is not None
        robot.close()
    assert caplog.text == ""
    assert robot.nao.world.called("setExternalCollisionProtectionEnabled") == [("All", True)]


def test_a_nao_is_no_pepper(project: Project) -> None:
    nao = FakeNao(lumen.load(ROOT).body)
    try:
        with pytest.raises(lumen.RobotModelError, match="this robot has no HipRoll, but models/Pepper does"):
            Lockstep(project, nao)
    finally:
        nao.close()


def test_only_keys_that_it_has_are_asked_for(robot: Lockstep) -> None:
    robot.nao.world.sonar, robot.nao.world.pressed = (0.9, 0.9), {"BackBumper"}
    joints, sonar, tactile = (robot.read(sense) for sense in (Sense.JOINT, Sense.SONAR, Sense.TACTILE))
    assert isinstance(joints, Joints)
    assert joints.names == tuple(robot.body.joints)
    assert joints.fsr == {}
    assert joints.inertial["AccelerometerZ"] == 9.81
    assert isinstance(sonar, Sonar)
    assert (sonar.left, sonar.right) == (0.9, 0.9)
    assert isinstance(tactile, Tactile)
    assert dict(zip(tactile.names, tactile.values, strict=True))["BackBumper"] == 1
    assert sum(tactile.values) == 1
    asked = robot.nao.world.asked
    assert "Device/SubDeviceList/Platform/Front/Sonar/Sensor/Value" in asked
    assert not [key for key in asked if "Foot" in key or "/US/" in key or "Knee/" in key or "InertialSensor/" in key]


def test_it_drives_ahead_and_aside(robot: Lockstep, live: LiveFor) -> None:
    robot.start("a", Walk(0.1, -0.05))
    assert answers(live(3.0)) == ["done.command.a"]
    assert robot.nao.world.called("moveTo") == [(0.1, -0.05, 0.0)]


def test_its_back_bumper_and_the_edge_of_the_stage_stop_it(robot: Lockstep, live: LiveFor) -> None:
    robot.start("a", Walk(0.3))
    assert "the base would leave the stage" in reason(live(0.5))
    robot.start("b", Walk(0.1))
    live(0.3)
    robot.touch("BackBumper", True)
    found = live(1.0)
    assert "the back bumper is pressed" in reason(found)


def test_head_postures_and_a_motion_of_its_own(robot: Lockstep, live: LiveFor, project: Project) -> None:
    robot.start("a", Look(0.3, 0.1))
    assert answers(live(3.0)) == ["done.command.a"]
    for name in ("Crouch", "StandZero", "StandInit", "Stand"):
        robot.start(name, Posture(name))
        assert answers(live(3.0)) == [f"done.command.{name}"]
    robot.start("sit", Posture("Sit"))
    assert reason(live(0.2)).startswith("no posture `Sit`: it knows")
    robot.start("b", Perform(project.motions["goodbye"]))
    assert answers(live(12.0)) == ["done.command.b"]
    [(names, *_)] = robot.nao.world.called("angleInterpolationBezier")
    assert "RElbowRoll" in names


def test_of_lights_it_has_no_feet(robot: Lockstep, live: LiveFor) -> None:
    robot.start("a", Leds({"eyes": "red", "feet": "blue"}))
    robot.start("b", Perform(MotionDefinition("show", 0.3, {}, (Cue(0.0, "leds", {"feet": "red", "chest": "red"}),))))
    assert sorted(answers(live(1.0))) == ["done.command.a", "done.command.b"]
    assert {group for group, *_ in robot.nao.world.called("fadeRGB")} == {"FaceLeds", "ChestLeds"}
    robot.start("c", Leds({"feet": "blue"}))
    assert reason(live(0.2)) == "`leds`: Pepper has no lights `feet`"


def test_it_breathes_with_its_arms_and_gestures(robot: Lockstep, live: LiveFor, project: Project) -> None:
    style = replace(project.life["lively"], naoqi=("breathing",))
    robot.start("", Live(style, merged(project.gestures)))
    robot.start("a", Posture("Stand"))
    live(5.0)
    assert robot.nao.world.called("setBreathEnabled") == [("Arms", True)]
    robot.start("", Live(project.life["lively"], merged(project.gestures)))
    robot.start("b", Say("Welcome, my friends, to all of our 27 big robots over there!", "en"))
    live(4.0)
    moved = {name for names, *_ in robot.nao.world.called("setAngles") for name in names}
    assert moved & set(robot.body.parts["arms"])
    assert not moved & set(robot.body.parts["legs"])


def test_after_a_fall_somebody_has_to_set_it_up(robot: Lockstep, live: LiveFor) -> None:
    robot.nao.tell("robotHasFallen", 1)
    robot.settle()
    assert answers(live(0.1)) == ["fallen"]
    robot.start("a", Posture("Stand"))
    assert reason(live(0.2)) == "the robot has fallen and cannot get up by itself: set it on its feet, then `wake` it"
    assert robot.nao.world.called("setStiffnesses") == []
    robot.start("b", Wake())
    assert answers(live(4.0)) == ["done.command.b"]
    robot.start("c", Rest())
    assert answers(live(3.0)) == ["done.command.c"]
