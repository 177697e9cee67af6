"""Standing, postures, rest, and falling: in physics."""

from collections.abc import Sequence
from itertools import chain, permutations

import numpy as np
import pytest

from lumen.features.simulation.balance import LEAN
from lumen.features.simulation.model_terms import Variation
from lumen.features.simulation.offers import SimulatedRobot
from lumen.language.commands import Look, Posture, Rest, Wake
from lumen.language.robots import Body
from tests.features.simulation.conftest import MODELS, Do, until_answered

STANDING = ("Stand", "StandInit", "StandZero", "Crouch")


@pytest.mark.once
def test_it_stands(robot: SimulatedRobot) -> None:
    robot.advance(10.0)
    assert robot.greatest_tilt < 2.0
    assert np.abs(robot.world.angles - robot.motors.goal).max() < 0.03 + LEAN
    assert np.abs(robot.world.speeds).max() < 0.02


@pytest.mark.parametrize(("speed", "way"), [(0.3, STANDING), (1.0, [*chain(*permutations(STANDING, 2))])], ids=str)
def test_it_changes_between_postures(
    robot: SimulatedRobot, do: Do, body: Body, speed: float, way: Sequence[str]
) -> None:
    for name in way:
        assert do(Posture(name, speed)) == "done"
        robot.advance(0.3)
        wanted = np.array(list(body.postures[name].values()))
        assert np.abs(robot.world.angles - wanted).max() < 0.06 + LEAN, name
    assert robot.greatest_tilt < 20.0


@pytest.mark.parametrize("mass", [0.9, 1.1])
@pytest.mark.parametrize("friction", [0.625, 1.25])  # of 0.8
def test_it_does_so_with_other_masses_and_floors(body: Body, mass: float, friction: float) -> None:
    robot = SimulatedRobot(body, MODELS, "hall.xml", variation=Variation(mass, friction))
    for name in ("Crouch", "Stand", "StandInit", "Crouch", "StandInit", "Stand"):
        robot.start(name, Posture(name, 1.0))
        until_answered(robot, name)
    assert robot.greatest_tilt < 20.0


def test_at_rest_it_crouches_with_its_motors_off(robot: SimulatedRobot, do: Do, body: Body) -> None:
    assert do(Rest()) == "done"
    assert not robot.awake
    robot.advance(20.0)
    legs = [robot.motors.index[n] for n in body.parts["legs"]]
    wanted = np.array([body.postures["Crouch"][n] for n in body.parts["legs"]])
    assert not robot.world.torques.any()
    assert np.abs(robot.world.angles[legs] - wanted).max() < 0.06
    assert robot.greatest_tilt < 8.0


def test_asleep_it_refuses_until_it_is_woken(robot: SimulatedRobot, do: Do) -> None:
    do(Rest())
    assert do(Look(0.2, 0.0)) == "error: the motors are off: `wake` first"
    assert do(Posture("Stand")) == "error: the motors are off: `wake` first"
    assert do(Rest()) == "done"
    assert do(Wake()) == "done"
    assert do(Look(0.2, 0.0)) == "done"
    assert robot.greatest_tilt < 20.0


def push(robot: SimulatedRobot, newton: float) -> None:
    force = robot.world.data.xfrc_applied[robot.world.torso]
    force[0] = newton
    robot.advance(0.1)
    force[0] = 0.0


def test_a_nudge_is_borne(robot: SimulatedRobot) -> None:
    push(robot, 12.0)
    robot.advance(3.0)
    assert not robot.fallen
    assert robot.world.tilt < 0.05


@pytest.mark.once
def test_a_fall_is_noticed_and_ends_everything(robot: SimulatedRobot, do: Do) -> None:
    robot.start("p", Posture("Crouch", 0.3))
    robot.advance(0.1)
    push(robot, 60.0)
    robot.advance(2.0)
    events = {event.name: event.data for event in robot.poll()}
    assert "fallen" in events
    assert events["error.command.p"] == {"reason": "the robot fell"}
    assert robot.fallen
    assert robot.motors.stiffness.max() <= 0.1
    assert do(Look(0.1, 0.0)).startswith("error: the robot has fallen")
    assert do(Rest()) == "done"
    assert do(Wake()) == "done"
    assert robot.world.tilt < 0.05
