"""A walk with legs that follow exactly, on ground that never gives way: the plan alone."""

from collections.abc import Mapping
from math import pi

import numpy as np
import pytest
from numpy.typing import NDArray

from lumen.motion.gait import Feet, Gait, Pose, middle
from lumen.motion.gait.footsteps import beside
from lumen.motion.gait.parameters import GaitParameters
from lumen.motion.gait.pendulum import Pendulum
from tests.gait.nao_legs import NAO_LEGS
from tests.motions.making import nao
from tests.tables import for_each

START: Feet = {"L": beside(Pose(), "L", GaitParameters()), "R": beside(Pose(), "R", GaitParameters())}
JOINTS = nao().joints
LIMIT = 6000


def mass(legs: Mapping[str, float]) -> NDArray[np.float64]:
    return np.array([0.01, 0.0, -0.05])


def walking(goal: Pose) -> Gait:
    return Gait(NAO_LEGS, START, goal, mass, GaitParameters())


class Walked:
    """Runs a gait to its end; `haste` is the greatest speed of a joint, as a part of its limit."""

    def __init__(self, gait: Gait, stop: int = LIMIT) -> None:
        angles, self.ticks, self.haste, self.lifted = dict(gait.angles), 0, 0.0, set[str]()
        while self.ticks < LIMIT and (tick := gait.tick(angles, gait.heading)):
            speeds = [abs(tick.angles[name] - angle) / 0.01 / JOINTS[name].speed for name, angle in angles.items()]
            self.haste = max(self.haste, *speeds)
            self.lifted |= {tick.lifted or ""}
            angles, self.ticks = dict(tick.angles), self.ticks + 1
            if self.ticks == stop:
                gait.stop()


GOALS = [(0.2, 0, 0), (-0.2, 0, 0), (0, 0.2, 0), (0, -0.1, 0), (0.3, 0.2, pi / 4), (-0.4, -0.2, 3.1), (2, 1, -3.1)]


@for_each("goal", GOALS)
def test_it_arrives(goal: tuple[float, float, float]) -> None:
    gait = walking(Pose(*goal))
    walked = Walked(gait)
    far, turned = gait.left
    assert walked.ticks < LIMIT
    assert far < 0.008
    assert turned < 0.02
    assert walked.haste < 1.0
    assert walked.lifted == {"", "L", "R"}


def test_where_it_stands_already_it_only_stands() -> None:
    gait = walking(Pose())
    assert gait.steps == 0
    assert Walked(gait).lifted == {""}


@for_each("moment", range(1, 320, 12))
def test_stopped_at_any_moment_it_ends_with_its_feet_together_within_a_second(moment: int) -> None:
    gait = walking(Pose(1.0, 0.3, 0.5))
    walked = Walked(gait, stop=moment)
    assert walked.ticks <= moment + 100
    assert gait.feet["L"].seen_from(gait.feet["R"]) == pytest.approx((0, 0.1, 0), abs=1e-6)
    assert walked.haste < 1.0


def test_a_foot_that_slipped_around_is_taken_into_account() -> None:
    """In its third step the torso turns by 0.2 rad that the encoders do not measure."""
    gait = walking(Pose(0.5, 0.0, 0.0))
    angles, ticks, turned = dict(gait.angles), 0, [0.0]
    while tick := gait.tick(angles, gait.heading + (0.2 if gait.steps == 2 else 0.0)):
        angles, ticks = dict(tick.angles), ticks + 1
        turned.append(middle(gait.feet).theta)
        assert ticks < LIMIT
    assert max(turned) == pytest.approx(0.2, abs=0.02)
    assert middle(gait.feet) == pytest.approx((0.5, 0.0, 0.0), abs=0.02)


def test_the_weight_is_planned_so_that_the_body_arrives() -> None:
    pendulum = Pendulum(0.26, 0.01)
    zmp, end = [complex(0.01 * k, 0.05) for k in range(20)], complex(0.2, 0.0)
    dcm = start = complex(0.0, 0.02)
    com = start
    for point in [p + pendulum.shift(start, zmp, end) for p in zmp]:
        com, dcm = pendulum.fall(com, dcm, point)
    assert dcm == pytest.approx(end)
    assert pendulum.backward([1 + 1j] * 50, 1 + 1j) == 1 + 1j
