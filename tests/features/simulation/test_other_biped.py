"""Another biped than NAO walks: Sprout, 0.40 m tall, with classic hips and soles of other proportions."""

from collections.abc import Mapping
from dataclasses import replace
from math import pi

import pytest

from lumen.features.simulation.biped import Biped
from lumen.language.commands import Look, Move, Posture, Rest, Wake, Walk
from lumen.ports import Joints, RobotCommand, Sense
from tests.features.simulation.bodies import shipped, standing
from tests.features.simulation.conftest import answer, until_answered
from tests.features.simulation.walks import any_robot, truth, walk

HALF_A_METRE = Walk(0.5)
ROBOTS = 20


def walks(seed: int) -> bool:
    """Return whether a robot of random masses, on a random floor, walks half a metre without a fall or great error."""
    walked = walk(any_robot(shipped("sprout"), seed), HALF_A_METRE)
    return walked.true and walked.upright


@pytest.mark.slow
@pytest.mark.parametrize("seed", [3, 11])
def test_it_walks_half_a_metre(seed: int) -> None:
    assert walks(seed)


@pytest.mark.soak
def test_all_of_them_walk_half_a_metre() -> None:
    assert [seed for seed in range(ROBOTS) if not walks(seed)] == []


@pytest.mark.slow
@pytest.mark.parametrize("command", [Walk(0.0, 0.1), Walk(0.0, 0.0, pi / 3), Walk(-0.1)], ids=str)
def test_it_walks_aside_around_and_back(command: Walk) -> None:
    walked = walk(standing("sprout"), command)
    assert walked.upright
    assert walked.off < 3.0


def test_its_hips_turn_by_themselves_and_its_steps_are_shorter() -> None:
    base = standing("sprout").base
    assert isinstance(base, Biped)
    assert not base.walker.legs.shared
    assert base.walker.legs.inclination == 0.0


@pytest.mark.slow
def test_it_moves_on_and_stops() -> None:
    robot = standing("sprout")
    robot.start("go", Move(0.08, 0.0, 0.0))
    robot.advance(4.0)
    assert 0.12 < truth(robot).x < 0.4
    robot.start("stay", Move(0.0, 0.0, 0.0))
    assert answer(until_answered(robot, "stay"), "stay") == "done"
    assert not robot.fallen


@pytest.mark.parametrize(
    "command", [Posture("Proud", 0.6), Look(0.3, 0.1), Rest(), Wake()], ids=lambda c: type(c).__name__
)
def test_it_does_what_it_has_parts_for(command: RobotCommand) -> None:
    robot = standing("sprout")
    robot.start("x", command)
    assert answer(until_answered(robot, "x"), "x") == "done"
    robot.advance(1.0)
    assert not robot.fallen


def test_its_soles_weigh_it() -> None:
    robot = standing("sprout")
    robot.advance(1.0)
    joints = robot.read(Sense.JOINT)
    assert isinstance(joints, Joints)
    mass = robot.world.model.body_subtreemass[robot.world.torso]
    assert joints.fsr["LFoot/FSR/TotalWeight"] + joints.fsr["RFoot/FSR/TotalWeight"] == pytest.approx(mass, rel=0.1)
    assert joints.fsr["LFoot/FSR/FrontLeft"] > 0.0


@pytest.mark.slow
@pytest.mark.parametrize("gait", [{}, shipped("sprout").gait], ids=["by rule", "found by a search"])
def test_it_goes_straight_ahead_briskly(gait: Mapping[str, Mapping[str, float]]) -> None:
    robot = any_robot(replace(shipped("sprout"), gait=gait), 5)
    robot.start("go", Move(1.0, 0.0, 0.0))
    robot.advance(9.0)
    assert not robot.fallen
    assert truth(robot).x - abs(truth(robot).y) > 1.4
