"""Steps that catch a fall, in simulated physics: varied robots rely on their own sensors alone."""

from math import hypot, inf, pi

import numpy as np
import pytest

from lumen.features.simulation import catching, skills
from lumen.features.simulation.balance import LEAN
from lumen.features.simulation.odometry import DRIFT_AFTER_CATCH
from lumen.features.simulation.offers import SimulatedRobot
from lumen.language.commands import Walk
from lumen.language.robots import Body
from tests.features.simulation.conftest import answer, until_answered
from tests.features.simulation.pushes import PushTrial, standing, upright
from tests.features.simulation.walks import Push, any_robot, truth

HARD = 3.0
"""An impulse from behind that ankles, hips and arms can't balance [N s]."""


def pushed(robot: SimulatedRobot, impulse: float, seconds: float, to: float = 0.0) -> bool:
    """Push the robot for 0.1 s, simulate `seconds`, and return True if it stepped to stay upright."""
    push, begin, stepped = Push(10 * impulse, 0.0, to), robot.time, False
    while robot.time < begin + seconds:
        push.act(robot, robot.time - begin)
        robot.advance(0.01)
        stepped |= robot.base.catching
    return stepped


def test_a_step_catches_it_and_the_robot_stands_again_as_before(body: Body) -> None:
    robot = any_robot(body, seed=3)
    robot.advance(1.0)
    assert pushed(robot, HARD, 6.0)
    assert not robot.fallen
    assert not robot.base.catching
    legs = [robot.motors.index[n] for n in body.parts["legs"]]
    wanted = np.array([body.postures["Stand"][n] for n in body.parts["legs"]])
    assert np.abs(robot.motors.command[legs] - wanted).max() < LEAN + 0.04
    assert robot.world.tilt < 0.1
    here, believed = truth(robot), robot.base.whereabouts
    assert here.x > 0.05
    assert hypot(here.x - believed.x, here.y - believed.y) < believed.doubt
    assert here.theta == pytest.approx(believed.theta, abs=0.15)


def test_nothing_but_a_step_does(body: Body, monkeypatch: pytest.MonkeyPatch) -> None:
    assert upright(body, standing, PushTrial(3, HARD, 0.0))
    monkeypatch.setattr(catching, "BEYOND_TOES", inf)
    assert not upright(body, standing, PushTrial(3, HARD, 0.0))


@pytest.mark.parametrize("to", [0.0, pi / 2, pi])
def test_a_nudge_takes_none(body: Body, to: float) -> None:
    robot = any_robot(body, seed=4)
    assert not pushed(robot, 1.0, 1.0, to)


def test_a_walk_goes_on_after_it(body: Body) -> None:
    robot = any_robot(body, seed=3)
    robot.start("w", Walk(0.3))
    robot.advance(0.2)
    begin = truth(robot)
    assert pushed(robot, HARD, 1.0)
    assert answer(until_answered(robot, "w"), "w") == "done"
    assert truth(robot).x - begin.x == pytest.approx(0.3, abs=DRIFT_AFTER_CATCH)
    assert not robot.fallen


@pytest.mark.soak
def test_twenty_robots_catch_themselves(body: Body) -> None:
    whole = 0
    for to in (-pi / 5, 0.0, pi / 5, pi / 2, -pi / 2):
        stood = sum(upright(body, standing, PushTrial(seed, HARD, to)) for seed in range(20))
        print(f"\n3 N s standing, towards {to:.2f} rad: {stood} of 20 upright")  # noqa: T201
        whole += stood
    assert whole >= 92


def head_meets_the_floor(body: Body, seed: int, to: float) -> float:
    """Push a robot over; return the greatest speed of its head as it reaches the floor, 0 if it does not [m/s]."""
    robot = any_robot(body, seed)
    robot.advance(0.5)
    model, data, push, begin = robot.world.model, robot.world.data, Push(60.0, 0.0, to), robot.time
    head, fastest = model.body("nao/HeadPitch").id, 0.0
    while robot.time < begin + 2.0:
        push.act(robot, robot.time - begin)
        before = float(np.linalg.norm(data.cvel[head][3:]))
        robot.advance(0.01)
        for contact in data.contact:
            touched = [int(model.geom_bodyid[g]) for g in (contact.geom1, contact.geom2)]
            if head in touched and any(not model.body(b).name.startswith("nao/") for b in touched):
                fastest = max(fastest, before)
    assert robot.fallen
    assert robot.motors.stiffness.max() <= 0.1
    return fastest


def test_arms_and_head_are_held_up_against_a_fall(body: Body) -> None:
    robot = any_robot(body, seed=3)
    found = [(body.roles.joint(path), angle) for path, angle in skills.BREAKS_A_FALL.items()]
    goals = {role.joint: role.sign * angle for role, angle in found if role}
    before = dict(zip(body.joints, robot.world.angles.tolist(), strict=True))
    push = Push(60.0, robot.time, 0.0)
    while not robot.fallen:
        push.act(robot, robot.time)
        robot.advance(0.01)
    stiffness = dict(zip(body.joints, robot.motors.stiffness.tolist(), strict=True))
    assert {stiffness[name] for name in body.parts["legs"]} == {skills.FALLEN_STIFFNESS}, "legs would be too slow"
    robot.advance(0.3)
    after = dict(zip(body.joints, robot.world.angles.tolist(), strict=True))
    left = {name: abs(after[name] - goal) / abs(before[name] - goal) for name, goal in goals.items()}
    held = {name: part for name, part in left.items() if "Shoulder" not in name}  # these the floor turns back
    assert len(held) == 3
    assert max(held.values()) < 0.5, left


@pytest.mark.soak
@pytest.mark.parametrize("to", [0.0, pi / 2])
def test_heads_meet_the_floor_more_slowly_for_that(body: Body, to: float, monkeypatch: pytest.MonkeyPatch) -> None:
    def falls() -> float:
        return sum(head_meets_the_floor(body, seed, to) for seed in range(20))

    held = falls()
    monkeypatch.setattr(skills, "BACKWARDS", -inf)
    assert held < 0.9 * falls()
