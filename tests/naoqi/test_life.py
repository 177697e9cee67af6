"""Life on a real NAO: head and arms move a little where nothing else moves the robot."""

from itertools import chain

import pytest

from lumen.language.commands import Posture, Rest, Say
from lumen.language.gestures import merged
from lumen.language.life import STILL_STYLE
from lumen.language.projects import Project
from lumen.ports import Live, Perform
from tests.naoqi.conftest import Live as LiveFor
from tests.naoqi.lockstep import Lockstep


def sent(robot: Lockstep) -> list[tuple[str, ...]]:
    """The joints of each call of `setAngles`."""
    return [tuple(names) for names, _, _ in robot.nao.world.called("setAngles")]


@pytest.fixture
def standing(robot: Lockstep, live: LiveFor, project: Project) -> Lockstep:
    robot.start("", Live(project.life["lively"], merged(project.gestures)))
    robot.start("a", Posture("Stand"))
    live(5.0)
    return robot


def test_head_and_arms_move_and_legs_do_not(standing: Lockstep, live: LiveFor, project: Project) -> None:
    before = standing.nao.world.joints.angles()
    live(2.0)
    after = standing.nao.world.joints.angles()
    moved = {joint for joint in before if abs(before[joint] - after[joint]) > 0.002}
    assert moved & set(project.body.parts["arms"])
    assert not set(chain.from_iterable(sent(standing))) & set(project.body.parts["legs"])


def test_arms_accompany_what_it_says(standing: Lockstep, live: LiveFor) -> None:
    stands, highest = standing.nao.world.joints.angles(), 0.0
    standing.start("b", Say("Welcome, my friends, to all of our 27 big robots over there!", "en"))
    for _ in range(40):
        live(0.1)
        angles = standing.nao.world.joints.angles()
        highest = max(highest, *(stands[joint] - angles[joint] for joint in ("LShoulderPitch", "RShoulderPitch")))
    assert highest > 0.2


def test_a_motion_is_left_alone(standing: Lockstep, live: LiveFor, project: Project) -> None:
    standing.start("b", Perform(project.motions["goodbye"]))
    live(0.1)
    before = len(sent(standing))
    live(2.0)
    assert len(sent(standing)) == before


@pytest.mark.parametrize("how", ["rests", "still", "never stood"])
def test_it_is_still(robot: Lockstep, live: LiveFor, project: Project, how: str) -> None:
    robot.start("", Live(project.life["lively"]))
    if how != "never stood":
        robot.start("a", Posture("Stand"))
        live(3.0)
    if how == "rests":
        robot.start("b", Rest())
    elif how == "still":
        robot.start("", Live(STILL_STYLE))
    live(4.0)
    before = len(sent(robot))
    live(2.0)
    assert len(sent(robot)) == before
