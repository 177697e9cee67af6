"""Walking: in physics, by encoders and gyrometer alone."""

from collections.abc import Sequence
from math import degrees, inf, nan, pi

import numpy as np
import pytest

from lumen.features.simulation.offers import SimulatedRobot
from lumen.language.commands import Look, Posture, Rest, Say, Stop, Walk
from lumen.language.motions import Keyframe, MotionDefinition
from lumen.language.projects import Stage
from lumen.language.robots import Body
from lumen.language.stories import Visitor
from lumen.motion.gait.footsteps import Footstep
from lumen.ports import Aim, Perform
from tests.features.simulation.conftest import MODELS, answer, until_answered
from tests.features.simulation.walks import TARGETS, Push, Walked, any_robot, on_the_floor, truth, walk

RUNS = 20
PUSH = 20.0
"""A force [N], which for 0.1 s is a push of 2 N s."""


def index(robot: SimulatedRobot, joint: str) -> float:
    return float(robot.world.angles[robot.motors.index[joint]])


def report(title: str, walks: list[Walked]) -> None:
    good = [w for w in walks if w.upright]
    print(  # noqa: T201
        f"\n{title}: {sum(w.true for w in walks)} of {len(walks)} true, {len(good)} upright, at most"
        f" {max(w.off for w in good):.1f} cm, {max(abs(w.turned) for w in good):.1f} deg off,"
        f" tilt {max(w.tilt for w in good):.0f} deg, {max(w.seconds for w in good):.1f} s"
    )


@pytest.mark.parametrize("posture", ["StandZero", "Crouch"])
def test_it_walks_from_any_posture_it_stands_in(body: Body, posture: str) -> None:
    assert walk(on_the_floor(body, posture=posture), Walk(0.2)).true


@pytest.mark.parametrize("target", TARGETS[1::3], ids=str)
def test_any_robot_ends_where_it_should(body: Body, target: Walk) -> None:
    walked = walk(any_robot(body, seed=1), target)
    assert walked.true, walked
    assert walked.tilt < 10


@pytest.mark.once
def test_it_walks_again_from_where_it_stands_and_can_do_everything_else_there(body: Body) -> None:
    robot = on_the_floor(body, posture="Crouch")
    for target in (Walk(0.1), Walk(-0.1, 0.0, -pi / 6)):
        assert walk(robot, target).true
    for command in (Posture("Stand"), Posture("Crouch"), Look(0.3, 0.0), Posture("Stand")):
        robot.start("c", command)
        assert answer(until_answered(robot, "c"), "c") == "done"
    assert walk(robot, Walk(0.0, 0.0, 0.3)).true
    robot.start("r", Rest())
    assert answer(until_answered(robot, "r"), "r") == "done"
    assert robot.greatest_tilt < 20


def test_a_push_while_walking_is_borne(body: Body) -> None:
    assert walk(any_robot(body, seed=2), Walk(0.3), Push(PUSH, at=2.3, to=1.0)).upright


@pytest.mark.soak
@pytest.mark.parametrize("target", TARGETS, ids=str)
def test_twenty_robots_end_where_they_should(body: Body, target: Walk) -> None:
    walks = [walk(any_robot(body, seed), target) for seed in range(RUNS)]
    report(f"({target.x:g}, {target.y:g}, {target.theta:.2f})", walks)
    assert sum(w.true for w in walks) == RUNS


@pytest.mark.soak
def test_pushes_are_survived_while_walking(body: Body) -> None:
    draw = np.random.default_rng(3)
    pushes = [Push(PUSH, draw.uniform(1.3, 4.5), draw.uniform(0, 2 * pi)) for _ in range(RUNS)]
    walks = [walk(any_robot(body, seed), Walk(0.3), push) for seed, push in enumerate(pushes)]
    report("pushed by 2 N s while walking", walks)
    assert sum(w.upright for w in walks) >= 18


@pytest.mark.soak
def test_pushes_are_survived_standing(body: Body) -> None:
    draw = np.random.default_rng(4)
    survived = 0
    for seed in range(RUNS):
        robot = any_robot(body, seed, "StandInit")
        push = Push(PUSH, robot.time + 0.1, draw.uniform(0, 2 * pi))
        for _ in range(300):
            push.act(robot, robot.time)
            robot.advance(0.01)
        survived += not robot.fallen
    print(f"\npushed by 2 N s standing: {survived} of {RUNS} upright")  # noqa: T201
    assert survived >= 18


@pytest.mark.parametrize(
    "moment", [0.4, 1.4, 1.7, 3.05, *(pytest.param(m, marks=pytest.mark.soak) for m in (0.9, 1.5, 2.1, 2.4))]
)
def test_a_cancelled_walk_ends_balanced_within_a_second(body: Body, moment: float) -> None:
    robot = on_the_floor(body)
    robot.start("w", Walk(0.5, 0.1, 0.4))
    robot.advance(moment)
    robot.cancel("w")
    assert answer(until_answered(robot, "w"), "w") == "cancelled"
    assert robot.time <= moment + 1.02
    robot.advance(2.0)
    assert robot.greatest_tilt < 10
    assert np.abs(robot.world.speeds).max() < 0.05


@pytest.mark.once
def test_stop_and_rest_win(body: Body) -> None:
    robot = on_the_floor(body)
    robot.start("w", Walk(0.5))
    robot.advance(2.2)
    robot.start("s", Stop("walk"))
    events = until_answered(robot, "s")
    assert answer(events, "w") == "cancelled"
    robot.start("w", Walk(0.5))
    robot.advance(2.0)
    robot.start("r", Rest())
    assert answer(until_answered(robot, "r"), "r") == "done"
    assert not robot.awake
    assert robot.greatest_tilt < 20


def test_arms_swing_against_the_legs(body: Body) -> None:
    robot = on_the_floor(body)
    hanging = index(robot, "LShoulderPitch")
    robot.start("w", Walk(0.4))
    robot.advance(2.0)
    left, right, lead = [], [], []
    for _ in range(150):
        robot.advance(0.02)
        left.append(index(robot, "LShoulderPitch"))
        right.append(index(robot, "RShoulderPitch"))
        lead.append(index(robot, "RHipPitch") - index(robot, "LHipPitch"))
    assert np.ptp(left) > 0.15
    assert np.corrcoef(left, right)[0, 1] < -0.8
    assert np.corrcoef(left, lead)[0, 1] > 0.3
    until_answered(robot, "w")
    robot.advance(0.5)
    assert index(robot, "LShoulderPitch") == pytest.approx(hanging, abs=0.03)


def test_a_gesture_is_kept_and_the_head_stays_free(body: Body) -> None:
    raised = MotionDefinition("raise", 1.0, {"RShoulderPitch": (Keyframe(1.0, -1.0),)})
    robot = on_the_floor(body)
    robot.start("m", Perform(raised))
    until_answered(robot, "m")
    robot.start("w", Walk(0.3))
    robot.start("t", Say("Look at my arm while I walk."))
    robot.start("", Aim({"HeadYaw": 0.5}))
    for _ in range(30):
        robot.advance(0.1)
        assert index(robot, "RShoulderPitch") == pytest.approx(-1.0, abs=0.1)
    assert index(robot, "HeadYaw") == pytest.approx(0.5, abs=0.05)
    events = until_answered(robot, "w")
    assert answer(events, "w") == "done"
    assert truth(robot).x == pytest.approx(0.3, abs=0.02)


@pytest.fixture
def staged(body: Body) -> SimulatedRobot:
    """The shipped robot on the podium."""
    return SimulatedRobot(body, MODELS, stage=Stage((-0.4, 0.4), (-0.6, 0.6)))


def refused(robot: SimulatedRobot, command: Walk) -> str:
    """Return the reason why the walk is refused; fail if the goal of a joint has changed."""
    goal = robot.motors.goal.copy()
    robot.start("w", command)
    result = answer(until_answered(robot, "w", 1.0), "w")
    assert result.startswith("error: ")
    assert (robot.motors.goal == goal).all()
    return result


@pytest.mark.parametrize(
    ("command", "reason"),
    [
        (Walk(0.5), "foot would leave the stage: it would reach x = 0.41 m, but the stage goes from -0.4 to 0.4 m"),
        (Walk(-0.6), "foot would leave the stage: it would reach x = -0.4"),
        (Walk(0.0, 0.7), "left foot would leave the stage: it would reach y = 0.6"),
        (Walk(3.0), "would leave the stage"),
        (Walk(1e9), "is too far: walk at most 10 m"),
        (Walk(nan), "no way to (nan, 0.0, 0.0)"),
        (Walk(0.1, inf), "no way to"),
        (Walk(0.1, 0.0, -inf), "no way to"),
    ],
)
def test_what_can_t_be_walked_is_refused_before_the_first_step(
    staged: SimulatedRobot, command: Walk, reason: str
) -> None:
    assert reason in refused(staged, command)


def test_the_stage_is_wide_enough_for_a_short_walk_and_remembered(staged: SimulatedRobot) -> None:
    for target in (Walk(0.2), Walk(0.0, 0.0, pi / 2)):
        staged.start("w", target)
        assert answer(until_answered(staged, "w"), "w") == "done"
    assert "the stage" in refused(staged, Walk(0.0, -0.25))
    staged.start("w", Walk(0.0, 0.2))
    assert answer(until_answered(staged, "w"), "w") == "done"


def test_the_rest_of_the_way_is_compared_with_the_stage_at_each_step(
    staged: SimulatedRobot, monkeypatch: pytest.MonkeyPatch
) -> None:
    odometry, looks = staged.base.odometry, list[int]()  # type: ignore[attr-defined]
    check = odometry.check

    def looking(steps: Sequence[Footstep], drift: float = 0.0) -> None:
        looks.append(len(steps))
        check(steps, drift)

    monkeypatch.setattr(odometry, "check", looking)
    staged.start("w", Walk(0.2))
    assert answer(until_answered(staged, "w"), "w") == "done"
    assert looks[0] <= len(looks) <= 2 * looks[0], "for each step, and not in each control period"


@pytest.mark.parametrize(
    ("sensor", "name"),
    [("RightBumper", "the right bumper"), ("LeftBumper", "the left bumper"), ("ChestButton", "the chest button")],
)
def test_a_button_ends_a_walk_and_lets_none_begin(staged: SimulatedRobot, sensor: str, name: str) -> None:
    staged.start("w", Walk(0.2))
    staged.advance(2.0)
    staged.touch(sensor, True)
    assert answer(until_answered(staged, "w", 1.2), "w") == f"error: {name} is pressed: the walk was stopped"
    staged.advance(1.0)
    assert staged.greatest_tilt < 10
    assert refused(staged, Walk(0.2)) == f"error: {name} is pressed: the robot did not start walking"
    staged.touch(sensor, False)
    staged.start("w", Walk(0.1))
    assert answer(until_answered(staged, "w"), "w") == "done"


def test_somebody_near_ends_a_walk_and_lets_none_begin(staged: SimulatedRobot) -> None:
    staged.place(Visitor(1.2, 0.0, 1.2))
    staged.start("w", Walk(0.2))
    staged.advance(2.0)
    staged.place(Visitor(0.45, 0.0, 1.2))
    result = answer(until_answered(staged, "w", 1.3), "w")
    assert result.startswith("error: something is 0.")
    assert result.endswith("m ahead, nearer than 0.4 m: the walk was stopped")
    assert "the robot did not start walking" in refused(staged, Walk(0.2))
    assert staged.greatest_tilt < 10


def test_a_fall_ends_a_walk(body: Body) -> None:
    walked = walk(on_the_floor(body), Walk(0.5), Push(90.0, at=2.0))
    assert walked.answer == "error: the robot fell"


def test_joints_stay_inside_limits_and_speeds(body: Body) -> None:
    robot = on_the_floor(body)
    robot.start("w", Walk(0.1, 0.1, 0.8))
    low = np.array([j.minimum for j in body.joints.values()])
    high = np.array([j.maximum for j in body.joints.values()])
    while not robot.poll():
        before = robot.motors.command.copy()
        robot.advance(0.01)
        assert (np.abs(robot.motors.command - before) <= robot.motors.envelope.speed * 0.0101).all()
        assert (robot.motors.command >= low).all()
        assert (robot.motors.command <= high).all()
    assert degrees(truth(robot).theta) == pytest.approx(degrees(0.8), abs=3)


def test_hot_motors_take_smaller_steps(body: Body) -> None:
    cool, hot = on_the_floor(body), on_the_floor(body)
    hot.condition.temperatures[hot.motors.index["LKneePitch"]] = 80.0
    hot.advance(0.2)
    slow, fast = walk(hot, Walk(0.2)), walk(cool, Walk(0.2))
    assert slow.true
    assert slow.seconds > fast.seconds + 1.0


def test_the_same_seed_walks_the_same_way(body: Body) -> None:
    ends = [walk(any_robot(body, seed=5), Walk(0.1)) for _ in range(2)]
    assert (ends[0].off, ends[0].turned) == (ends[1].off, ends[1].turned)
