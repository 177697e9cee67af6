"""Long walks, and floors that are not flat: whether robots stay upright, how far off they end, and odometry's errors.

Bounds are what was measured, a little rounded up; `python benchmarks/walking.py --robots 20` prints the figures, and
docs/decisions/074 lists the figures that miss their targets. A walk of five metres costs
5 s of CPU, but shorter walks do not show the drift.
"""

from math import pi
from typing import NamedTuple

import pytest

from lumen.language.commands import Walk
from lumen.language.robots import Body
from tests.features.simulation.walks import RESTED, any_robot, bump, ramp, strayed, walk


class Way(NamedTuple):
    """A walk over the geoms `more` (MJCF), with the limits of its errors."""

    more: str
    target: Walk
    off: float
    """The greatest distance from its goal at which it may end [cm]."""
    strayed: float
    """The greatest error of odometry [cm]."""
    rest: float = 0.0
    """The time before the walk in which the resting robot estimates its gyrometer's bias [s]."""


WAYS = {
    "rails of 5 mm": Way(bump(0.005), Walk(1.2), 2.5, 2.5),
    "up 5 degrees": Way(ramp(5.0), Walk(1.0), 3.5, 3.0),
    "5 m straight": Way("", Walk(5.0), 6.5, 6.5, RESTED),
}


def check(body: Body, way: Way, seed: int) -> None:
    robot = any_robot(body, seed, more=way.more)
    robot.advance(way.rest)
    walked = walk(robot, way.target)
    print(f"robot {seed}: off {walked.off:.1f} cm, odometry {strayed(robot):.1f} cm, tilt {walked.tilt:.0f} deg")  # noqa: T201
    assert walked.upright, walked
    assert walked.off < way.off
    assert strayed(robot) < way.strayed


@pytest.mark.parametrize("name", WAYS)
def test_a_robot_gets_there(body: Body, name: str) -> None:
    check(body, WAYS[name], seed=1)


@pytest.mark.soak
@pytest.mark.parametrize("seed", range(20))
@pytest.mark.parametrize("name", WAYS)
def test_each_of_twenty_robots_gets_there(body: Body, name: str, seed: int) -> None:
    check(body, WAYS[name], seed)


@pytest.mark.soak
@pytest.mark.parametrize("seed", range(10))
def test_a_robot_walks_up_across_and_down_a_slope(body: Body, seed: int) -> None:
    """Over 2.3 m with two turns, soles slide downhill, which no sensor feels. Of 30 robots one ends 3.8 cm off."""
    robot = any_robot(body, seed, more=ramp(5.0))
    for target in (Walk(1.0), Walk(0.0, 0.0, pi / 2), Walk(0.3), Walk(0.0, 0.0, pi / 2), Walk(1.0)):
        walked = walk(robot, target)
        assert walked.upright, walked
        assert walked.off < 4.0
    print(f"robot {seed}: odometry {strayed(robot):.1f} cm")  # noqa: T201
    assert strayed(robot) < 0.05 * 230
