"""Pushes against a robot that stands, walks or dances, and how many robots stay on their feet."""

from collections.abc import Callable, Sequence
from math import pi
from typing import NamedTuple

import numpy as np

from lumen.features.simulation.offers import SimulatedRobot
from lumen.language.commands import Move
from lumen.language.motions import MotionDefinition
from lumen.language.robots import Body
from lumen.ports import Perform
from tests.features.simulation.walks import Push, any_robot

SETTLE = 1.0
"""The time for which a robot settles before the trial [s]."""

AFTER = 3.0
"""The time that a robot is observed after a push [s]."""

DIRECTIONS = tuple(2 * pi * k / 10 for k in range(10))
"""Directions of pushes [rad]: 0 is forward, pi / 2 to the robot's left."""

Doing = Callable[[SimulatedRobot], None]
"""Starts the robot's activity during the push."""


class PushTrial(NamedTuple):
    """A push of `impulse` [N s] for 0.1 s towards `to` [rad], `at` seconds after the robot of that seed has begun."""

    seed: int
    impulse: float
    to: float
    at: float = 0.1


def standing(robot: SimulatedRobot) -> None:
    """Let the robot stand."""


def walking(robot: SimulatedRobot) -> None:
    """Let the robot walk on at 0.1 m/s."""
    robot.start("it", Move(0.1, 0.0, 0.0))


def walking_briskly(robot: SimulatedRobot) -> None:
    """Let the robot walk on at 0.2 m/s, which takes the brisk pace."""
    robot.start("it", Move(0.2, 0.0, 0.0))


def dancing(dance: MotionDefinition) -> Doing:
    """Return a function that lets a robot play that motion."""
    return lambda robot: robot.start("it", Perform(dance))


def upright(body: Body, doing: Doing, trial: PushTrial) -> bool:
    """Return whether that robot, in Stand, still stands `AFTER` seconds after its push."""
    robot = any_robot(body, trial.seed)
    push = Push(10 * trial.impulse, trial.at, trial.to)
    robot.advance(SETTLE)
    doing(robot)
    begin = robot.time
    while robot.time < begin + trial.at + AFTER and not robot.fallen:
        push.act(robot, robot.time - begin)
        robot.advance(0.01)
    return not robot.fallen


def anywhere(count: int, impulse: float, moments: tuple[float, float]) -> Sequence[PushTrial]:
    """Return pushes in random directions, at random times between these moments [s]; equal for equal arguments."""
    draw = np.random.default_rng(7)
    drawn = [(draw.uniform(*moments), draw.uniform(0, 2 * pi)) for _ in range(count)]
    return [PushTrial(seed, impulse, to, at) for seed, (at, to) in enumerate(drawn)]
