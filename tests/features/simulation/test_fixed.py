"""A robot fixed in place, without legs, wheels or arms: it looks around, changes posture, and never moves away."""

import numpy as np
import pytest

from lumen.features.simulation.offers import SimulatedRobot
from lumen.language.commands import Look, Posture, Rest, Say, Wake, Walk
from lumen.ports import Joints, RobotCommand, Sense
from tests.features.simulation.bodies import standing
from tests.features.simulation.conftest import answer, until_answered


@pytest.fixture
def lantern() -> SimulatedRobot:
    return standing("lantern")


def does(robot: SimulatedRobot, command: RobotCommand) -> str:
    robot.start("x", command)
    return answer(until_answered(robot, "x"), "x")


def test_it_has_no_free_joint(lantern: SimulatedRobot) -> None:
    assert not (lantern.world.model.jnt_type == 0).any()


@pytest.mark.parametrize(
    "command",
    [Look(0.5, 0.2), Posture("Curious", 0.8), Say("Hello", "en"), Rest(), Wake()],
    ids=lambda c: type(c).__name__,
)
def test_it_does_what_it_has_parts_for(lantern: SimulatedRobot, command: RobotCommand) -> None:
    assert does(lantern, command) == "done"


def test_it_does_not_walk(lantern: SimulatedRobot) -> None:
    assert "neither legs nor wheels" in does(lantern, Walk(0.2))


def test_a_push_moves_nothing_but_its_joints(lantern: SimulatedRobot) -> None:
    place = lantern.world.data.body(lantern.world.torso).xpos.copy()
    lantern.world.data.xfrc_applied[lantern.world.torso][:2] = 200.0, 100.0
    lantern.advance(0.2)
    lantern.world.data.xfrc_applied[:] = 0.0
    lantern.advance(1.0)
    assert np.array_equal(lantern.world.data.body(lantern.world.torso).xpos, place)
    assert not lantern.fallen


def test_it_lives_and_does_not_say_where_it_is(lantern: SimulatedRobot) -> None:
    lantern.advance(2.0)
    joints = lantern.read(Sense.JOINT)
    assert isinstance(joints, Joints)
    assert joints.position is None
    assert joints.fsr == {}
    assert lantern.read(Sense.SONAR) is None
