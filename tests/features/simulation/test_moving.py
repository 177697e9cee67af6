"""Continuous walks in physics: steered on the way, and ended by each event that ends a walk."""

from math import nan

import numpy as np
import pytest

from lumen.features.simulation.offers import SimulatedRobot
from lumen.language.commands import Move, Posture, Stop, Walk
from lumen.language.projects import Stage
from lumen.language.robots import Body
from lumen.motion.gait import FOUND, Footstep, GaitParameters, corners, fastest
from lumen.motion.gait.poses import wrap
from tests.features.simulation.conftest import MODELS, answer, until_answered
from tests.features.simulation.walks import Push, any_robot, feet, on_the_floor, truth
from tests.gait.nao_legs import NAO_LEGS

STAGE = Stage((-0.4, 0.4), (-0.6, 0.6))
FASTEST = fastest(GaitParameters())
GRACE = 0.01
"""The distance beyond the stage's edge at which a foot may land [m]: the encoders' error."""


@pytest.fixture
def staged(body: Body) -> SimulatedRobot:
    """A robot on the floor, with the podium's stage."""
    return on_the_floor(body, stage=STAGE)


def steered(robot: SimulatedRobot, moves: list[Move], each: float) -> None:
    """Give the robot each of these commands for `each` [s]; then let it stand."""
    for i, move in enumerate(moves):
        robot.start(f"m{i}", move)
        robot.advance(each)
    robot.start("s", Stop("walk"))
    until_answered(robot, "s", 1.1)
    robot.advance(0.5)


def test_it_walks_as_fast_as_it_is_told_and_stands_when_it_is_told_nothing(body: Body) -> None:
    robot = any_robot(body, seed=1)
    robot.start("a", Move(0.1))
    robot.advance(3.0)
    begin = truth(robot)
    robot.advance(2.7)
    assert truth(robot).seen_from(begin).x == pytest.approx(0.27, abs=0.04)
    robot.start("b", Move())
    events = until_answered(robot, "b", 2.0)
    assert answer(events, "a") == "done"
    assert answer(events, "b") == "done"
    robot.advance(0.5)
    assert np.abs(robot.world.speeds).max() < 0.05
    assert robot.greatest_tilt < 10


def test_it_is_steered_to_and_fro_without_a_stop(body: Body) -> None:
    robot = any_robot(body, seed=2)
    ahead, back, left, around = Move(FASTEST.x), Move(-FASTEST.x), Move(0.0, FASTEST.y), Move(0.0, 0.0, -FASTEST.theta)
    steered(robot, [ahead, back, left, around, Move(9.0, -9.0, 9.0)], 2.0)
    assert robot.greatest_tilt < 15
    assert np.abs(robot.world.speeds).max() < 0.05


def full_speed(body: Body, seed: int, command: Move, seconds: float) -> tuple[bool, float, float, float]:
    """Return whether the robot stayed upright, and its speed ahead and aside [m/s] and in turning [rad/s]."""
    robot = any_robot(body, seed)
    robot.start("m", command)
    robot.advance(3.0)
    begin, turned, heading = truth(robot), 0.0, truth(robot).theta
    for _ in range(round(seconds / 0.1)):
        robot.advance(0.1)
        now = truth(robot).theta
        turned, heading = turned + wrap(now - heading), now
    way = truth(robot).seen_from(begin)
    stayed = not robot.fallen and not robot.base.catching
    return stayed, way.x / seconds, way.y / seconds, turned / seconds


BRISK = [(Move(1.0), 1, 0.2), (Move(0.0, 1.0), 2, 0.12), (Move(0.0, 0.0, 9.0), 3, 0.85)]
"""The command, the index of its speed in the result, and the least speed that the robot must reach."""


@pytest.mark.parametrize(("command", "speed", "least"), BRISK)
def test_it_goes_briskly_where_speed_is_asked_for(body: Body, command: Move, speed: int, least: float) -> None:
    reached = full_speed(body, 1, command, 3.0)
    assert reached[0]
    assert reached[speed] > least


def test_it_changes_from_one_pace_to_the_other_under_way(body: Body) -> None:
    robot = any_robot(body, seed=4)
    steered(robot, [Move(0.1), Move(1.0), Move(0.05), Move(0.0, 0.0, 9.0)], 1.5)
    assert not robot.fallen
    assert robot.greatest_tilt < 15


@pytest.mark.soak
@pytest.mark.parametrize(("command", "speed", "least"), BRISK)
def test_twenty_robots_go_briskly(body: Body, command: Move, speed: int, least: float) -> None:
    reached = [full_speed(body, seed, command, 8.0) for seed in range(20)]
    print(f"\n{command}: {sum(r[0] for r in reached)} of 20 upright, {np.mean([r[speed] for r in reached]):.3f}")  # noqa: T201
    assert sum(r[0] for r in reached) == 20
    assert np.mean([r[speed] for r in reached]) > least


@pytest.mark.soak
def test_twenty_robots_are_steered_at_random(body: Body) -> None:
    draw = np.random.default_rng(7)
    upright = 0
    for seed in range(20):
        robot = any_robot(body, seed)
        moves = [Move(*(draw.uniform(-1, 1) * most for most in FASTEST)) for _ in range(8)]
        steered(robot, moves, draw.uniform(0.3, 2.5))
        upright += robot.greatest_tilt < 15
    print(f"\nsteered at random: {upright} of 20 upright")  # noqa: T201
    assert upright == 20


def pushed(robot: SimulatedRobot, push: Push) -> None:
    """Let the robot walk at 0.1 m/s for 6 s, or until it falls, with that push."""
    robot.start("m", Move(0.1))
    begin = robot.time
    while robot.time < begin + 6.0 and not robot.fallen:
        push.act(robot, robot.time - begin)
        robot.advance(0.01)


def test_a_push_outward_as_the_other_foot_leaves_is_borne(body: Body) -> None:
    robot = any_robot(body, seed=6)
    pushed(robot, Push(18.0, at=1.89, to=1.22))
    assert robot.greatest_tilt < 15


@pytest.mark.soak
def test_pushes_are_survived_while_it_moves(body: Body) -> None:
    draw, upright = np.random.default_rng(8), 0
    for seed in range(20):
        robot, push = any_robot(body, seed), Push(20.0, draw.uniform(1.3, 4.5), draw.uniform(0, 6.28))
        pushed(robot, push)
        upright += not robot.fallen
    print(f"\npushed by 2 N s while moving: {upright} of 20 upright")  # noqa: T201
    assert upright >= 18


@pytest.mark.parametrize("move", [Move(0.14), Move(0.05, -0.06, -0.3), Move(-0.1, 0.05)], ids=str)
def test_it_ends_at_the_edge_of_the_stage_with_both_feet_on_it(staged: SimulatedRobot, move: Move) -> None:
    staged.start("m", move)
    farthest = 0.0
    while not (result := answer(events := list(staged.poll()), "m")):
        staged.advance(0.05)
        assert staged.time < 60, events
    for side, pose in feet(staged).items():
        for corner in corners(Footstep(side, pose), NAO_LEGS.sole_size):
            farthest = max(farthest, abs(corner.real) - 0.4, abs(corner.imag) - 0.6)
    assert "foot would leave the stage" in result
    assert result.endswith("the walk was stopped")
    assert farthest < GRACE
    assert farthest > -0.15
    if move.vtheta:
        return  # by now it faces elsewhere
    staged.start("back", Move(-move.vx, -move.vy))
    staged.advance(2.0)
    assert not answer(list(staged.poll()), "back")


def test_what_is_pressed_ends_it_and_what_is_no_number_changes_nothing(staged: SimulatedRobot) -> None:
    staged.start("m", Move(0.05))
    staged.advance(1.5)
    staged.start("nan", Move(nan))
    reason = answer(until_answered(staged, "nan", 0.1), "nan")
    assert reason == "error: the robot cannot walk at (nan, 0.0, 0.0)"
    staged.touch("ChestButton", True)
    assert answer(until_answered(staged, "m", 1.2), "m") == "error: the chest button is pressed: the walk was stopped"
    staged.start("n", Move(0.05))
    assert "the robot did not start walking" in answer(until_answered(staged, "n", 1.0), "n")


def test_a_walk_or_a_posture_ends_it_and_begins(staged: SimulatedRobot) -> None:
    for command in (Walk(-0.05), Posture("StandInit")):
        staged.start("m", Move(0.05))
        staged.advance(1.7)
        staged.start("c", command)
        events = until_answered(staged, "c")
        assert [answer(events, id) for id in "mc"] == ["done", "done"]
    assert staged.greatest_tilt < 10


def test_after_a_fall_no_move_goes_on_from_the_one_that_fell(body: Body) -> None:
    robot = on_the_floor(body)
    robot.start("m", Move(0.1))
    push = Push(90.0, at=2.0)
    events = []
    while not answer(events, "m"):
        push.act(robot, robot.time)
        robot.advance(0.01)
        events += robot.poll()
    assert answer(events, "m") == "error: the robot fell"
    robot.start("n", Move(0.1))
    assert "has fallen" in answer(until_answered(robot, "n", 1.0), "n")


def test_hot_motors_move_slowly(body: Body) -> None:
    robot = SimulatedRobot(body, MODELS)
    robot.condition.temperatures[robot.motors.index["LKneePitch"]] = 80.0
    robot.advance(0.2)
    robot.start("m", Move(FASTEST.x))
    robot.advance(4.0)
    assert robot.world.data.qpos[0] < 4.0 * fastest(FOUND.gentle).x
