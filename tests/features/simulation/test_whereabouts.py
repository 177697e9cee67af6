"""The robot's estimate of its place, also after it was on the floor."""

from math import degrees, pi

import pytest

from lumen.errors import RobotError
from lumen.features.simulation.odometry import DRIFT_AFTER_FALL, DRIFT_AFTER_LYING_BACK, DRIFT_AFTER_SITTING, Odometry
from lumen.features.simulation.offers import SimulatedRobot
from lumen.language.commands import Posture, Wake, Walk
from lumen.language.projects import Stage
from lumen.language.robots import Body
from lumen.motion.gait import Footstep, Pose, middle
from lumen.motion.gait.poses import wrap
from tests.features.simulation.conftest import answer, until_answered
from tests.features.simulation.test_postures import shoved
from tests.features.simulation.walks import any_robot, on_the_floor, truth
from tests.gait.nao_legs import NAO_LEGS

WIDE = Stage((-1.0, 1.0), (-1.0, 1.0))
STANDING = dict.fromkeys(
    (s + n for s in "LR" for n in ("HipYawPitch", "HipRoll", "HipPitch", "KneePitch", "AnklePitch", "AnkleRoll")), 0.0
)


def test_once_down_the_stage_is_smaller_by_as_much_as_nobody_knows() -> None:
    whereabouts = Odometry(NAO_LEGS, WIDE)
    whereabouts.feel(STANDING)
    whereabouts.check([Footstep("L", Pose(0.85, 0.05))])
    for posture in ("Crouch", "Straddle", "LyingBack", "Straddle"):
        whereabouts.lose(posture)
    whereabouts.keep(0.0)
    whereabouts.feel(STANDING)
    assert whereabouts.doubt == DRIFT_AFTER_LYING_BACK
    whereabouts.check([Footstep("L", Pose(0.6, 0.05))])
    with pytest.raises(
        RobotError,
        match=r"might leave the stage: .* to 1 m; the robot has fallen since, so its position may be wrong by 0\.25",
    ):
        whereabouts.check([Footstep("L", Pose(0.7, 0.05))])
    whereabouts.lose("Sit")
    whereabouts.keep(0.0)
    whereabouts.lose("")
    assert whereabouts.doubt == DRIFT_AFTER_LYING_BACK + DRIFT_AFTER_SITTING + DRIFT_AFTER_FALL


def test_feet_in_doubt_may_stay_where_they_stand() -> None:
    whereabouts = Odometry(NAO_LEGS, Stage((-0.2, 0.2), (-0.2, 0.2)))
    whereabouts.feel(STANDING)
    whereabouts.lose("Sit")
    whereabouts.feel(STANDING)
    for side, pose in whereabouts.feet.items():
        whereabouts.check([Footstep(side, pose)])
    with pytest.raises(RobotError):
        whereabouts.check([Footstep("L", Pose(0.05, 0.05))])


def test_what_it_turned_while_it_was_down_counts_and_what_it_drifts_while_it_stands_does_not() -> None:
    whereabouts = Odometry(NAO_LEGS, WIDE)
    for heading in (0.1, 0.2):
        whereabouts.keep(heading)
    whereabouts.lose("Sit")
    whereabouts.keep(0.2 + pi / 2)
    assert middle(whereabouts.feel(STANDING)).theta == pytest.approx(pi / 2)


def test_a_robot_that_sat_walks_only_where_it_is_safe_all_the_same(body: Body) -> None:
    robot = on_the_floor(body, stage=Stage((-0.6, 0.6), (-0.6, 0.6)))
    for posture in ("Sit", "Stand"):
        robot.start("p", Posture(posture))
        assert answer(until_answered(robot, "p"), "p") == "done"
    assert abs(truth(robot).place) < DRIFT_AFTER_SITTING
    robot.start("w", Walk(0.5))
    assert "the robot has fallen since, so its position may be wrong by 0.1 m" in answer(
        until_answered(robot, "w"), "w"
    )
    robot.start("w", Walk(0.3))
    assert answer(until_answered(robot, "w"), "w") == "done"


def believed(robot: SimulatedRobot) -> Pose:
    """Return the robot's own estimate of its pose, relative to its start."""
    return middle(robot.base.odometry.feet)


@pytest.mark.parametrize("seed", [pytest.param(0, marks=pytest.mark.soak), 2])
def test_a_robot_that_fell_on_its_way_knows_where_it_faces(body: Body, seed: int) -> None:
    robot = any_robot(body, seed)
    robot.start("w", Walk(0.0, 0.0, pi / 2))
    robot.advance(6.0)
    shoved(robot, seed)
    robot.start("k", Wake())
    until_answered(robot, "k", 120.0)
    robot.start("w", Walk(0.05))
    assert answer(until_answered(robot, "w"), "w") == "done"
    off = truth(robot).seen_from(believed(robot))
    assert abs(off.place) < DRIFT_AFTER_FALL
    assert abs(degrees(wrap(off.theta))) < 10
