"""A behaviour that keeps walking at a speed: in a story, in a turn of some length, and written out again."""

from math import pi

import pytest

from lumen.language.commands import Move, Start, Walk
from lumen.project.formats.behavior_data import plain_action
from lumen.robot.recording import RecordingRobot
from lumen.statechart import Interpreter, Machine, initial
from tests.motions.making import nao

MACHINE = {
    "id": "stroll",
    "units": {"angle": "deg", "length": "cm"},
    "events": {"enough": None},
    "initial": "walking",
    "states": {
        "walking": {"do": [{"walk": {"vx": 5, "vtheta": 9}}], "after": {"3s": "faster"}},
        "faster": {"do": [{"walk": {"vx": 10}}], "on": {"enough": "standing"}},
        "standing": {"entry": [{"stop": "walk"}]},
    },
}


def test_it_walks_on_until_the_state_is_left() -> None:
    it = Interpreter(Machine.from_dict(MACHINE))
    (started,) = [c for c in it.start().commands if isinstance(c, Start)]
    assert isinstance(started.command, Move)
    assert started.command.vx == pytest.approx(0.05)
    assert started.command.vtheta == pytest.approx(pi / 20)
    it.clock.advance(2.9)
    assert it.configuration == {"walking"}
    it.clock.advance(0.2)
    assert it.configuration == {"faster"}


def ended(robot: RecordingRobot, id: str, limit: float) -> float:
    """Return the time at which that command was answered with `done` [s]."""
    while robot.time < limit:
        robot.advance(0.1)
        if any(e.name == f"done.command.{id}" for e in robot.poll()):
            return robot.time
    raise AssertionError(f"`{id}` was not done within {limit} s")


def test_a_turn_on_the_spot_takes_its_time_in_a_story() -> None:
    robot = RecordingRobot(nao())
    robot.start("turn", Walk(0.0, 0.0, pi / 2))
    assert 5.0 < ended(robot, "turn", 20.0) < 8.0


def test_a_move_in_a_story_goes_on_until_another_one_or_a_walk_ends_it() -> None:
    robot = RecordingRobot(nao())
    robot.start("a", Move(0.1))
    robot.advance(60.0)
    assert robot.poll() == []
    robot.start("b", Move(0.0, 0.0, 0.2))
    ended(robot, "a", 62.0)
    robot.start("c", Walk(0.1))
    ended(robot, "b", 64.0)
    ended(robot, "c", 67.0)
    robot.start("d", Move())
    ended(robot, "d", 70.0)
    assert [command for _, command in robot.performed] == [Move(0.1), Move(0.0, 0.0, 0.2), Walk(0.1), Move()]


@pytest.mark.parametrize("move", [Move(0.1, 0.0, 0.2), Move(), Move(-0.05)])
def test_it_is_written_as_it_is_read(move: Move) -> None:
    written = {**MACHINE, "units": {}, "states": {"a": {"entry": [plain_action(move)]}}, "initial": "a"}
    (started,) = [c for c in initial(Machine.from_dict(written), at=0.0).commands if isinstance(c, Start)]
    assert started.command == move
