"""Where the robot believes to be, and what it makes of having been down."""

import pytest

from lumen.errors import RobotError
from lumen.interpreters.gait import Pose, Step
from lumen.language.commands import Posture, Walk
from lumen.language.projects import Stage
from lumen.language.robots import Body
from lumen.robots.simulation.whereabouts import ASTRAY, Whereabouts
from tests.simulation.conftest import answer, until_answered
from tests.simulation.walks import on_the_floor, truth

WIDE = Stage((-1.0, 1.0), (-1.0, 1.0))
STANDING = dict.fromkeys(
    (s + n for s in "LR" for n in ("HipYawPitch", "HipRoll", "HipPitch", "KneePitch", "AnklePitch", "AnkleRoll")), 0.0
)


def test_once_down_the_stage_is_smaller_by_as_much_as_nobody_knows() -> None:
    whereabouts = Whereabouts(WIDE)
    whereabouts.feel(STANDING)
    whereabouts.check([Step("L", Pose(0.85, 0.05))])
    for _ in range(3):
        whereabouts.lose()
    whereabouts.feel(STANDING)
    assert whereabouts.doubt == ASTRAY
    whereabouts.check([Step("L", Pose(0.55, 0.05))])
    with pytest.raises(
        RobotError, match=r"might leave the stage: .* to 1 m; the robot has been down since, and may be 0\.3"
    ):
        whereabouts.check([Step("L", Pose(0.65, 0.05))])
    whereabouts.lose()
    whereabouts.feel(STANDING)
    assert whereabouts.doubt == 2 * ASTRAY


def test_feet_in_doubt_may_stay_where_they_stand() -> None:
    whereabouts = Whereabouts(Stage((-0.2, 0.2), (-0.2, 0.2)))
    whereabouts.feel(STANDING)
    whereabouts.lose()
    whereabouts.feel(STANDING)
    for side, pose in whereabouts.feet.items():
        whereabouts.check([Step(side, pose)])
    with pytest.raises(RobotError):
        whereabouts.check([Step("L", Pose(0.05, 0.05))])


def test_a_robot_that_sat_walks_only_where_it_is_safe_all_the_same(body: Body) -> None:
    robot = on_the_floor(body, stage=Stage((-0.7, 0.7), (-0.7, 0.7)))
    for posture in ("Sit", "Stand"):
        robot.start("p", Posture(posture))
        assert answer(until_answered(robot, "p"), "p") == "done"
    moved = abs(truth(robot).place)
    assert moved < ASTRAY
    robot.start("w", Walk(0.4))
    reason = answer(until_answered(robot, "w"), "w")
    assert "the robot has been down since, and may be 0.3 m off" in reason
    robot.start("w", Walk(0.15))
    assert answer(until_answered(robot, "w"), "w") == "done"
