"""Continuous walking, with legs that follow exactly: the plan alone."""

from collections.abc import Mapping
from dataclasses import replace
from math import hypot

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from lumen.motion.gait import FOUND, Gait, GaitParameters, Pose, Velocity, fastest, fastest_of, middle
from lumen.motion.gait.footsteps import MOST_CHANGE, strides
from lumen.motion.gait.legs import other, sign
from tests.features.simulation.bodies import shipped
from tests.gait.nao_legs import NAO_LEGS
from tests.gait.test_gait import JOINTS, LIMIT, START
from tests.tables import for_each

PACE = GaitParameters()
STEP = PACE.double + PACE.single


def mass(legs: Mapping[str, float]) -> NDArray[np.float64]:
    return np.array([0.01, 0.0, -0.05])


class Legs:
    """Legs that follow the gait, with no joint faster than its limit."""

    def __init__(self, gait: Gait) -> None:
        self.gait, self.angles = gait, dict(gait.angles)

    def tick(self) -> bool:
        tick = self.gait.tick(self.angles, self.gait.heading)
        if tick is None:
            return False
        for name, angle in tick.angles.items():
            assert abs(angle - self.angles[name]) <= JOINTS[name].speed * 0.01
        self.angles = dict(tick.angles)
        return True

    def walk(self, ticks: int) -> None:
        """Walk for this number of ticks of 0.01 s."""
        assert all(self.tick() for _ in range(ticks))

    def end(self) -> int:
        """Return the number of ticks until the walk ends."""
        return next(ticks for ticks in range(LIMIT) if not self.tick())


VELOCITIES = [(0.1, 0, 0), (-0.1, 0, 0), (0, 0.05, 0), (0, -0.05, 0), (0, 0, 0.4), (0, 0, -0.4), (0.05, 0.02, 0.1)]


@for_each("velocity", VELOCITIES, ids=str)
def test_it_goes_as_fast_as_it_is_told(velocity: tuple[float, float, float]) -> None:
    """Measured over ten steps from the second on: first the weight must shift."""
    gait = Gait(NAO_LEGS, START, Velocity(*velocity), mass, PACE)
    legs = Legs(gait)
    legs.walk(36 + 4 * 45)
    start, steps = middle(gait.feet), gait.steps
    legs.walk(10 * 45)
    assert gait.steps == steps + 10
    part, body = Pose(), Pose(*(v * STEP for v in velocity))
    for _ in range(10):
        part = part.then(body)
    assert tuple(middle(gait.feet).seen_from(start)) == pytest.approx(tuple(part), abs=0.02)


def test_no_speed_at_all_ends_it_with_the_feet_together() -> None:
    gait = Gait(NAO_LEGS, START, Velocity(0.1, 0.0, 0.2), mass, PACE)
    legs = Legs(gait)
    legs.walk(250)
    gait.goal = Velocity()
    assert legs.end() < 200
    assert gait.feet["L"].seen_from(gait.feet["R"]) == pytest.approx((0, 0.1, 0), abs=0.015)


def test_from_standing_no_speed_moves_nothing() -> None:
    gait = Gait(NAO_LEGS, START, Velocity(), mass, PACE)
    assert Legs(gait).end() < 60
    assert gait.steps == 0


@for_each("moment", range(1, 320, 24))
def test_stopped_at_any_moment_it_ends_within_a_second(moment: int) -> None:
    gait = Gait(NAO_LEGS, START, Velocity(0.1, 0.03, 0.2), mass, PACE)
    legs = Legs(gait)
    legs.walk(moment)
    gait.stop()
    assert legs.end() <= 100
    assert gait.feet["L"].seen_from(gait.feet["R"]) == pytest.approx((0, 0.1, 0), abs=1e-6)


speeds = st.floats(-100, 100)


@given(speeds, speeds, speeds, st.sampled_from("LR"), st.sampled_from([PACE, FOUND.gentle]))
def test_whatever_is_asked_feet_neither_touch_nor_stride_too_far(
    x: float, y: float, theta: float, first: str, pace: GaitParameters
) -> None:
    bearing = START
    for side, pose in strides(START, Velocity(x, y, theta), first, pace, 8):
        seen = pose.seen_from(bearing[other(side)])
        assert pace.narrowest - 1e-9 <= sign(side) * seen.y <= PACE.widest + 1e-9
        assert abs(seen.x) <= pace.forward + pace.apart * pace.turn
        assert abs(seen.theta) <= pace.turn + 1e-9
        bearing = {**bearing, side: pose}


def test_what_is_too_fast_keeps_its_way() -> None:
    slow = Velocity(10.0, 0.0, -20.0).within(PACE)
    most = fastest(PACE)
    assert slow.x / slow.theta == pytest.approx(-0.5)
    assert hypot(slow.x / most.x, slow.theta / most.theta) == pytest.approx(1.0)
    assert Velocity(0.01, 0.0, 0.0).within(PACE) == (0.01, 0.0, 0.0)


def test_a_speed_changes_step_by_step_and_gets_there() -> None:
    most, speed = fastest(PACE), Velocity(0.1, 0.0, 0.3)
    there = Velocity(-9.0, 0.0, 0.0)
    for _ in range(7):
        before, speed = speed, speed.toward(there, PACE)
        change = hypot(*((b - a) / limit for a, b, limit in zip(before, speed, most, strict=True)))
        assert change < MOST_CHANGE + 1e-9
    assert speed == pytest.approx((-most.x, 0.0, 0.0))


def test_how_fast_a_body_goes_is_told_by_its_base() -> None:
    nao = shipped("nao")
    assert fastest_of(nao, "brisk") == fastest(FOUND.brisk)
    assert fastest_of(nao, "usual") == fastest(PACE)
    slower = replace(nao, gait={"usual": {"forward": 0.04}})
    assert fastest_of(slower, "usual").x == pytest.approx(0.04 / STEP)
    assert fastest_of(shipped("greeter"), "brisk") == (0.5, 0.0, 1.2)
