"""Down to the floor and up again, in simulated physics: robots of different weights on different floors."""

from collections.abc import Sequence
from dataclasses import replace
from math import degrees

import mujoco
import numpy as np
import pytest

from lumen.features.simulation.balance import LEAN
from lumen.features.simulation.offers import SimulatedRobot
from lumen.language.commands import Posture, Rest, Stop, Wake, Walk
from lumen.language.motions import Keyframe, MotionDefinition
from lumen.language.robots import Body
from lumen.motion.postures import RESTFUL, UPRIGHT, route
from lumen.ports import Perform
from tests.features.simulation.conftest import Do, answer, until_answered
from tests.features.simulation.walks import any_robot

RUNS = 20
DOWN = ("Sit", "SitRelax", "LyingBack", "LyingBelly")
TOUCHDOWN = 0.3
"""The greatest speed at which the pelvis may reach the floor [m/s]."""


def told(robot: SimulatedRobot, posture: str) -> str:
    robot.start("p", Posture(posture))
    return answer(until_answered(robot, "p", 120.0), "p")


def standing(robot: SimulatedRobot) -> bool:
    robot.advance(0.5)
    return degrees(robot.world.tilt) < 5 and not robot.fallen


def load(robot: SimulatedRobot, *parts: str) -> float:
    """Return the share of the robot's weight that these links carry."""
    model, data, force = robot.world.model, robot.world.data, 0.0
    for i in range(data.ncon):
        names = {model.body(model.geom_bodyid[g]).name for g in data.contact[i].geom}
        if names & {f"nao/{part}" for part in parts} and not all(name.startswith("nao/") for name in names):
            wrench = np.zeros(6)
            mujoco.mj_contactForce(model, data, i, wrench)
            force += wrench[0]
    return force / (9.81 * sum(model.body_mass[i] for i in range(model.nbody) if model.body(i).name.startswith("nao/")))


def trips(seeds: Sequence[int], body: Body, posture: str) -> int:
    """Count the robots that reach the posture and then stand up again."""
    good = 0
    for seed in seeds:
        robot = any_robot(body, seed)
        down = told(robot, posture) == "done"
        good += down and told(robot, "Stand") == "done" and standing(robot)
    return good


@pytest.mark.parametrize("posture", ["Sit", "LyingBelly"])
def test_any_robot_gets_down_and_up_again(body: Body, posture: str) -> None:
    assert trips([1], body, posture) == 1


@pytest.mark.soak
@pytest.mark.parametrize("posture", DOWN)
def test_twenty_robots_get_down_and_up_again(body: Body, posture: str) -> None:
    good = trips(range(RUNS), body, posture)
    print(f"\n{posture} and back: {good} of {RUNS}")  # noqa: T201
    assert good >= 18


def shoved(robot: SimulatedRobot, angle: float) -> None:
    """Push the torso in that direction [rad] until the robot has fallen."""
    torso = robot.world.torso
    robot.world.data.xfrc_applied[torso, :2] = 60 * np.cos(angle), 60 * np.sin(angle)
    robot.advance(0.15)
    robot.world.data.xfrc_applied[torso, :2] = 0.0
    robot.advance(2.5)
    assert robot.fallen


def falls(seeds: Sequence[int], body: Body) -> int:
    """Count the robots that get up after a push has thrown them over in a random direction."""
    good = 0
    for seed in seeds:
        robot = any_robot(body, seed)
        shoved(robot, np.random.default_rng(seed).uniform(0, 2 * np.pi))
        robot.start("w", Wake())
        good += answer(until_answered(robot, "w", 120.0), "w") == "done" and standing(robot)
    return good


def test_a_robot_that_fell_gets_up(body: Body) -> None:
    assert falls([0, 3], body) == 2


@pytest.mark.soak
def test_twenty_robots_that_fell_get_up(body: Body) -> None:
    good = falls(range(RUNS), body)
    print(f"\npushed over and up again: {good} of {RUNS}")  # noqa: T201
    assert good >= 18


def test_it_sits_down_gently_and_its_pelvis_carries_it(robot: SimulatedRobot) -> None:
    robot.start("p", Posture("Sit"))
    fastest, before = 0.0, 0.0
    while not answer(robot.poll(), "p"):
        speed = -float(robot.world.data.qvel[2])
        fastest = max(fastest, before if load(robot, "Torso") > 0.05 else 0.0)
        before = speed
        robot.advance(0.01)
    robot.advance(0.5)
    assert fastest < TOUCHDOWN
    assert load(robot, "Torso") > 0.5
    assert degrees(robot.world.tilt) < 35


@pytest.mark.parametrize("posture", [*DOWN, "Crouch"])
def test_every_joint_is_where_naoqi_has_it(robot: SimulatedRobot, do: Do, body: Body, posture: str) -> None:
    assert do(Posture(posture)) == "done"
    robot.advance(0.5)
    assert np.abs(robot.world.angles - list(body.postures[posture].values())).max() < 0.06 + LEAN


@pytest.mark.parametrize("posture", ["Crouch", "Sit"])
def test_it_rests_with_its_motors_off(robot: SimulatedRobot, do: Do, body: Body, posture: str) -> None:
    assert do(Posture(posture)) == "done"
    assert do(Rest()) == "done"
    assert not robot.awake
    robot.advance(2.0)
    legs = [i for name, i in robot.motors.index.items() if "Hip" in name or "Knee" in name]
    before, tilt = robot.world.angles[legs], robot.world.tilt
    robot.advance(8.0)
    assert np.abs(robot.world.angles[legs] - before).max() < 0.02
    assert np.abs(robot.world.angles[legs] - [body.postures[posture][robot.motors.names[i]] for i in legs]).max() < 0.15
    assert abs(robot.world.tilt - tilt) < 0.05
    assert do(Wake()) == "done"
    assert standing(robot)


@pytest.mark.parametrize("moment", [2.0, pytest.param(5.0, marks=pytest.mark.soak), 8.5])
def test_stop_halts_it_on_the_way_and_it_goes_on_from_there(robot: SimulatedRobot, do: Do, moment: float) -> None:
    robot.start("p", Posture("Sit"))
    robot.advance(moment)
    robot.start("s", Stop())
    events = until_answered(robot, "s")
    assert answer(events, "p") == "cancelled"
    assert robot.time <= moment + 0.5
    robot.advance(1.0)
    assert do(Posture("Stand")) == "done"
    assert standing(robot)


def test_what_needs_feet_is_refused_on_the_floor(robot: SimulatedRobot, do: Do) -> None:
    wave = MotionDefinition("wave", 1.0, {"HeadYaw": (Keyframe(1.0, 0.1),)}, start="Stand")
    assert do(Posture("Sit")) == "done"
    assert do(Walk(0.1)) == "error: the robot is in Sit: send it to Stand first"
    assert do(Perform(wave)) == "error: `wave` begins in Stand; the robot is in Sit: send it there first"
    assert do(Perform(replace(wave, start="Sit"))) == "done"


def test_the_quickest_route(body: Body) -> None:
    assert route(body, "Stand", "Stand") == []
    assert route(body, "StandInit", "Crouch") == ["Crouch"]
    assert route(body, "Stand", "Sit") == ["Crouch", "Straddle", "Sit"]
    assert route(body, "Straddle", *RESTFUL) in (["Sit"], ["SitRelax"], ["LyingBack"], ["Crouch"])
    assert route(replace(body, passages=()), "Sit", "Stand") is None


def test_every_posture_is_reached_from_every_other(body: Body) -> None:
    assert [(a, b) for a in body.postures for b in body.postures if route(body, a, b) is None] == []
    assert set(UPRIGHT) < set(body.postures)
