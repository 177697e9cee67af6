"""The positions of footsteps."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from lumen.motion.gait.footsteps import (
    Feet,
    beside,
    corners,
    first_side,
    footsteps,
    middle,
)
from lumen.motion.gait.legs import other, sign
from lumen.motion.gait.parameters import GaitParameters
from lumen.motion.gait.poses import Pose
from tests.gait.nao_legs import NAO_LEGS

PACE = GaitParameters()
HERE = Pose(1.0, -2.0, 0.7)
FEET: Feet = {"L": beside(HERE, "L", PACE), "R": beside(HERE, "R", PACE)}
ways = st.builds(Pose, st.floats(-1, 1), st.floats(-1, 1), st.floats(-3, 3))


@given(ways)
def test_steps_alternate_stay_short_and_end_side_by_side_at_the_goal(way: Pose) -> None:
    goal = HERE.then(way)
    steps = footsteps(FEET, goal, first_side(way), PACE)
    feet = dict(FEET)
    for i, step in enumerate(steps):
        assert step.side == (steps[0].side if i % 2 == 0 else other(steps[0].side))
        seen = step.pose.seen_from(feet[other(step.side)])
        assert PACE.narrowest - 1e-9 <= sign(step.side) * seen.y <= PACE.widest + 1e-9
        assert abs(seen.x) < 0.13
        assert abs(seen.theta) < 0.3
        feet[step.side] = step.pose
    assert feet["L"].seen_from(feet["R"]).y > 0.08
    there = goal.seen_from(middle(feet))
    assert abs(complex(there.x, there.y)) < 1e-6
    assert abs(there.theta) < 1e-9


def test_a_walk_begins_with_the_foot_it_leads_to() -> None:
    assert first_side(Pose(0.2, 0.0, 0.0)) == "L"
    assert first_side(Pose(0.2, -0.1, 0.5)) == "R"
    assert first_side(Pose(0.0, 0.0, -0.5)) == "R"


def test_a_sole_lies_around_its_ankle() -> None:
    [step] = footsteps(FEET, HERE, "L", PACE)[:1]
    ahead = [(point - step.pose.place) / step.pose.ahead for point in corners(step, NAO_LEGS.sole_size)]
    assert max(p.real for p in ahead) - min(p.real for p in ahead) == pytest.approx(0.14)
    assert max(p.imag for p in ahead) > -min(p.imag for p in ahead)
