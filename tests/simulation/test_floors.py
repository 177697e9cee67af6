"""Far walks, and floors that are not flat: who stays upright, how far off, and what odometry believes.

Bounds are what was measured, a little rounded up; `python benchmarks/walking.py --robots 20` prints the figures, and
docs/decisions/074 says which of them fall short of what is wanted. Five metres cost
5 s of CPU: what strays shows only then.
"""

from typing import NamedTuple

import pytest

from lumen.language.commands import Walk
from lumen.language.robots import Body
from tests.simulation.walks import any_robot, bump, ramp, strayed, walk


class Way(NamedTuple):
    """A walk over geoms `more`, how far beside its goal it may end and how far odometry may be wrong [cm]."""

    more: str
    target: Walk
    off: float
    strayed: float


WAYS = {
    "rails of 5 mm": Way(bump(0.005), Walk(1.2), 7.0, 7.0),
    "up 5 degrees": Way(ramp(5.0), Walk(1.0), 4.0, 4.0),
    "5 m straight": Way("", Walk(5.0), 25.0, 25.0),
}


def check(body: Body, way: Way, seed: int) -> None:
    robot = any_robot(body, seed, more=way.more)
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
