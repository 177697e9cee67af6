"""The four motions on the simulated robot: it stays upright, keeps up, and shows what the motion is about."""

from collections.abc import Callable
from functools import cache
from typing import NamedTuple

import numpy as np
import pytest

from lumen.features.simulation.model_terms import ROBOT_PREFIX, Variation
from lumen.features.simulation.robot import SimulatedRobot
from lumen.motion import Motion
from lumen.ports import Perform
from tests import ROOT
from tests.motions.making import SHIPPED, nao

Point = np.ndarray
STEP = 0.05
MOUTH, HEAD_TOP, HAND = (0.05, 0.0, 0.028), (0.0, 0.0, 0.108), (0.05775, 0.0, -0.01231)


class Moment(NamedTuple):
    """One look at the robot: the places of its parts [m]."""

    time: float
    """Since the beginning of the motion [s]."""
    right_hand: Point
    left_hand: Point
    right_shoulder: Point
    mouth: Point
    head_top: Point
    soles: tuple[float, ...]
    """The heights of the left and the right sole [m]."""
    error: float
    """The greatest distance of a joint from the angle that its motor should have [rad]; hands do not count."""
    collisions: frozenset[tuple[str, str]]
    """The pairs of the robot's own geoms that overlap by more than 1 mm."""


class Show(NamedTuple):
    moments: list[Moment]
    events: list[str]
    tilt: float
    """The greatest tilt of the torso while the robot was upright [degrees]."""
    took: float
    """The duration until the answer [s]."""

    def between(self, begin: float, end: float) -> list[Moment]:
        return [moment for moment in self.moments if begin <= moment.time <= end]


def look(robot: SimulatedRobot, time: float) -> Moment:
    data, model = robot.world.data, robot.world.model

    def point(body: str, at: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> Point:
        frame = data.body(f"{ROBOT_PREFIX}/{body}")
        return np.array(frame.xpos + frame.xmat.reshape(3, 3) @ np.array(at))

    wanted = robot.motors.wanted(nao().joints)
    error = max(abs(wanted[n] - a) for n, a in zip(nao().joints, robot.world.angles, strict=True) if n[1:] != "Hand")
    touching = [c for c in data.contact[: data.ncon] if c.dist < -1e-3]
    names = {(model.geom(c.geom1).name, model.geom(c.geom2).name) for c in touching}
    own = frozenset(pair for pair in names if all(name.startswith(f"{ROBOT_PREFIX}/") for name in pair))
    return Moment(
        time,
        point("RWristYaw", HAND),
        point("LWristYaw", HAND),
        point("RShoulderPitch"),
        point("HeadPitch", MOUTH),
        point("HeadPitch", HEAD_TOP),
        tuple(float(data.site(f"{ROBOT_PREFIX}/{side}Sole").xpos[2]) for side in "LR"),
        error,
        own,
    )


@cache
def show(name: str, mass: float = 1.0, friction: float = 1.0) -> Show:
    """Play a motion from Stand to its end, and return what was observed."""
    motion = Motion.load(ROOT / "motions" / f"{name}.yaml")
    robot = SimulatedRobot(nao(), ROOT / "models", seed=1, variation=Variation(mass, friction))
    robot.advance(0.5)
    begin, events, moments = robot.time, list[str](), list[Moment]()
    robot.start("it", Perform(motion))
    while "done.command.it" not in events and robot.time < begin + motion.duration + 3.0:
        robot.advance(STEP)
        events += [event.name for event in robot.poll()]
        moments.append(look(robot, robot.time - begin))
    tilt, took = robot.greatest_tilt, robot.time - begin
    robot.close()
    return Show(moments, events, tilt, took)


@pytest.mark.parametrize("name", [pytest.param(one, marks=[pytest.mark.once] * (one == "dance")) for one in SHIPPED])
def test_it_finishes_upright_and_in_time(name: str) -> None:
    seen = show(name)
    assert seen.events == ["done.command.it"]
    assert seen.tilt < 10.0
    assert seen.took < Motion.load(ROOT / f"motions/{name}.yaml").duration + 0.2


@pytest.mark.parametrize(
    ("name", "mass", "friction"), [("goodbye", 0.9, 0.625), ("dance", 0.9, 0.625), ("dance", 1.1, 1.25)]
)
def test_a_lighter_and_a_heavier_robot_on_other_floors_stay_upright(name: str, mass: float, friction: float) -> None:
    seen = show(name, mass, friction)
    assert seen.events == ["done.command.it"]
    assert seen.tilt < 20.0


@pytest.mark.soak
def test_no_motion_falls_on_any_of_twenty_robots_and_floors() -> None:
    draw = np.random.default_rng(7)
    for i in range(20):
        name = SHIPPED[i % len(SHIPPED)]
        assert show(name, draw.uniform(0.9, 1.1), draw.uniform(0.625, 1.25)).tilt < 20.0


@pytest.mark.parametrize("name", SHIPPED)
def test_the_joints_follow(name: str) -> None:
    assert max(moment.error for moment in show(name).moments) < 0.3


@pytest.mark.parametrize("name", SHIPPED)
def test_nothing_of_the_robot_runs_into_the_rest_of_it(name: str) -> None:
    assert {pair for moment in show(name).moments for pair in moment.collisions} == set()


def test_the_waving_hand_is_above_the_shoulder_and_swings() -> None:
    waving = show("goodbye").between(1.3, 3.2)
    assert all(m.right_hand[2] > m.right_shoulder[2] + 0.1 for m in waving)
    assert spread(waving, lambda m: m.right_hand[1]) > 0.08


def test_the_microphone_is_at_the_mouth_while_the_left_arm_waves() -> None:
    singing = show("sing").between(1.5, 38.0)
    assert all(np.linalg.norm(m.right_hand - m.mouth) < 0.06 for m in singing)
    assert spread(singing, lambda m: m.left_hand[2]) > 0.15


def test_the_lasso_circles_above_the_head_on_either_side() -> None:
    beat = 60 / 132
    for begin, hand in ((12, lambda m: m.right_hand), (20, lambda m: m.left_hand)):
        swinging = show("dance").between((begin + 0.3) * beat, (begin + 6) * beat)
        assert all(hand(m)[2] > m.head_top[2] for m in swinging)
        assert spread(swinging, lambda m, hand=hand: hand(m)[0] - m.head_top[0]) > 0.06
        assert spread(swinging, lambda m, hand=hand: hand(m)[1] - m.head_top[1]) > 0.06


def test_the_reins_are_crossed_before_the_chest() -> None:
    beat = 60 / 132
    riding = show("dance").between(3 * beat, 10 * beat)
    assert all(np.linalg.norm(m.right_hand - m.left_hand) < 0.1 for m in riding)
    assert all(m.right_hand[0] > m.right_shoulder[0] + 0.08 for m in riding)


def test_the_dance_ends_on_one_leg() -> None:
    """The right foot is in the air for more than a second, 15 mm high and more; the left one stays on the floor."""
    dancing = show("dance").moments
    floor = dancing[0].soles
    lifted = [m for m in dancing if m.soles[1] > floor[1] + 0.015]
    assert len(lifted) * STEP > 1.0
    assert all(abs(m.soles[0] - floor[0]) < 0.003 for m in lifted)
    assert abs(dancing[-1].soles[1] - floor[1]) < 0.002


def spread(moments: list[Moment], of: Callable[[Moment], float]) -> float:
    values = [of(moment) for moment in moments]
    return max(values) - min(values)
