"""The estimated position of the supporting foot, from legs and gyrometer."""

import pytest

from lumen.motion.gait import Feet, Gait, GaitParameters, Pose
from lumen.motion.gait.footsteps import beside
from lumen.motion.gait.gait import StepTracker
from tests.gait.nao_legs import NAO_LEGS
from tests.gait.test_gait import mass

HERE = Pose(1.0, 2.0, 0.5)
FEET: Feet = {"L": beside(HERE, "L", GaitParameters()), "R": beside(HERE, "R", GaitParameters())}


def standing(feet: Feet) -> dict[str, float]:
    """Return the angles of legs on these feet [rad]."""
    return dict(Gait(NAO_LEGS, feet, Pose(), mass, GaitParameters()).angles)


def test_what_a_sole_turns_in_a_step_counts_however_little_it_is() -> None:
    angles = standing(FEET)
    tracker = StepTracker(NAO_LEGS, FEET, angles, 0.3)
    assert tracker.stands("L", FEET, angles, 0.3) == pytest.approx(FEET["L"], abs=1e-6)
    assert tracker.stands("L", FEET, angles, 0.305).theta == pytest.approx(HERE.theta + 0.005)


def test_a_foot_stands_where_it_came_to_rest_once_both_were_on_the_ground() -> None:
    tracker = StepTracker(NAO_LEGS, FEET, standing(FEET), 0.0)
    for ahead in (0.002, 0.004):
        tracker.look("R", standing({**FEET, "L": FEET["L"].then(Pose(ahead))}))
    slid = tracker.stands("L", FEET, standing(FEET), 0.0)
    assert slid.place == pytest.approx(FEET["L"].then(Pose(0.003)).place, abs=1e-6)
    assert tracker.stands("L", FEET, standing(FEET), 0.0).place == pytest.approx(FEET["L"].place)
