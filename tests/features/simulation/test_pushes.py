"""How hard the robot is to push over; `python benchmarks/pushes.py` prints the whole table."""

from math import pi

import pytest

from lumen.language.robots import Body
from tests.features.simulation.pushes import DIRECTIONS, PushTrial, standing, upright

ROBOTS = 20


@pytest.mark.parametrize("to", [0.0, pi / 2, -pi / 2, 0.8 * pi, pi, -0.8 * pi])
def test_a_push_is_borne_standing(body: Body, to: float) -> None:
    assert upright(body, standing, PushTrial(5, 2.0, to))


def test_one_that_is_far_too_hard_is_not(body: Body) -> None:
    assert not upright(body, standing, PushTrial(5, 8.0, 0.0))


@pytest.mark.soak
@pytest.mark.parametrize("to", DIRECTIONS)
def test_twenty_robots_bear_pushes_from_there(body: Body, to: float) -> None:
    stood = sum(upright(body, standing, PushTrial(seed, 2.0, to)) for seed in range(ROBOTS))
    print(f"\n2 N s standing, towards {to:.2f} rad: {stood} of {ROBOTS} upright")  # noqa: T201
    assert stood >= ROBOTS - 1
