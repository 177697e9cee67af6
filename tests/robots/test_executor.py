"""Ownership, order and answers, with activities that last as long as the test says."""

import pytest

from lumen.errors import RobotError
from lumen.language.commands import Look, Move, Posture, Rest, Say, Stop, Walk
from lumen.ports import RobotCommand
from lumen.robot.executor import Executor
from lumen.robot.skill_runner import SkillRunner

PARTS = {Say: {"voice"}, Posture: {"head", "arms", "legs"}, Look: {"head"}, Rest: {"head", "arms", "legs"}, Stop: set()}


class Fake:
    """An activity that lasts until `until` [s]; after a cancellation it lasts `balance` [s] longer."""

    def __init__(self, command: RobotCommand, now: float, balance: float) -> None:
        self.until, self.balance, self.now = now + 2.0, balance, now

    def advance(self, now: float) -> bool:
        self.now = now
        return now >= self.until

    def cancel(self) -> None:
        self.until = self.now + self.balance


def executor(balance: float = 0.0) -> Executor:
    return Executor(lambda c, now: Fake(c, now, balance), lambda c: frozenset(PARTS[type(c)]), SkillRunner().begin)


def names(events: list) -> list[str]:
    return [e.name for e in events]


def test_commands_on_different_parts_run_at_once() -> None:
    ex = executor()
    ex.start("a", Say("hello"))
    ex.start("b", Look(0.1, 0))
    assert ex.advance(0.0) == []
    assert (ex.owner("voice"), ex.owner("head"), ex.owner("legs")) == ("a", "b", "")
    assert names(ex.advance(2.0)) == ["done.command.a", "done.command.b"]
    assert not ex.busy


def test_a_command_waits_for_its_parts_and_keeps_them_from_those_behind() -> None:
    ex = executor()
    ex.start("look", Look(0.1, 0))
    ex.advance(0.0)
    ex.start("stand", Posture("Stand"))
    ex.start("again", Look(0.2, 0))
    ex.advance(1.0)
    assert ex.owner("legs") == ""
    ex.advance(2.0)
    assert ex.owner("head") == "stand"
    ex.advance(4.0)
    assert ex.owner("head") == "again"


def test_rest_cancels_everything_and_waits_only_for_balance() -> None:
    ex = executor(balance=0.5)
    ex.start("say", Say("a long story"))
    ex.start("stand", Posture("Stand"))
    ex.advance(0.0)
    ex.start("later", Look(0, 0))
    ex.start("rest", Rest())
    assert names(ex.advance(0.1)) == ["cancelled.command.later"]
    assert names(ex.advance(0.6)) == ["cancelled.command.stand", "cancelled.command.say"]
    assert ex.owner("legs") == "rest"


def test_asking_for_rest_again_does_not_put_it_off() -> None:
    ex = executor()
    ex.start("rest", Rest())
    ex.advance(0.0)
    for tick in range(1, 10):
        ex.start(f"again{tick}", Rest())
        answers = names(ex.advance(tick * 0.25))
        if tick == 8:
            assert answers == ["done.command.rest"]


def test_stop_ends_only_its_channel_and_answers_when_that_is_over() -> None:
    ex = executor(balance=0.5)
    ex.start("say", Say("hello"))
    ex.start("look", Look(0, 0))
    ex.advance(0.0)
    ex.start("stop", Stop("say"))
    assert names(ex.advance(0.2)) == []
    assert names(ex.advance(0.5)) == ["cancelled.command.say"]
    assert names(ex.advance(0.6)) == ["done.command.stop"]
    assert ex.owner("head") == "look"


@pytest.mark.parametrize("cancelled", ["nobody", "a"])
def test_cancelling_is_harmless_when_repeated_or_unknown(cancelled: str) -> None:
    ex = executor()
    ex.start("a", Say("x"))
    ex.cancel(cancelled)
    ex.cancel(cancelled)
    events = names(ex.advance(0.0))
    assert events == ([] if cancelled == "nobody" else ["cancelled.command.a"])


def test_what_the_body_refuses_is_an_error_and_the_next_goes_on() -> None:
    def begin(command: RobotCommand, now: float) -> Fake:
        if isinstance(command, Posture):
            raise RobotError("can't sit")
        return Fake(command, now, 0)

    ex = Executor(begin, lambda c: frozenset(PARTS[type(c)]), SkillRunner().begin)
    ex.start("sit", Posture("Sit"))
    ex.start("look", Look(0, 0))
    [answer] = ex.advance(0.0)
    assert (answer.name, answer.data) == ("error.command.sit", {"reason": "can't sit"})
    assert ex.owner("head") == "look"


def test_a_fall_fails_all() -> None:
    ex = executor()
    ex.start("a", Say("x"))
    ex.start("b", Say("y"))
    ex.advance(0.0)
    ex.fail("the robot fell")
    assert [(e.name, e.data) for e in ex.advance(0.1)] == [
        ("error.command.a", {"reason": "the robot fell"}),
        ("error.command.b", {"reason": "the robot fell"}),
    ]


class Endless(Fake):
    """An activity that moves until it is ended."""

    def __init__(self, command: RobotCommand, now: float) -> None:
        super().__init__(command, now, 0.5)
        self.until = now + 1.0 if isinstance(command, Walk) else 1e9


def walking() -> Executor:
    def begin(command: RobotCommand, now: float) -> Endless:
        if command == Move(9.0):
            raise RobotError("too fast")
        return Endless(command, now)

    return Executor(begin, lambda c: frozenset(() if isinstance(c, Stop) else {"legs"}), SkillRunner().begin)


def test_a_move_goes_on_from_another_one_without_a_stop() -> None:
    ex = walking()
    ex.start("a", Move(0.1))
    ex.advance(0.0)
    ex.start("b", Move(0.2))
    assert names(ex.advance(1.0)) == ["done.command.a"]
    assert ex.owner("legs") == "b"
    assert ex.begun() == ["a", "b"]


def test_a_move_that_is_refused_leaves_the_one_before_going() -> None:
    ex = walking()
    ex.start("a", Move(0.1))
    ex.advance(0.0)
    ex.start("b", Move(9.0))
    assert names(ex.advance(1.0)) == ["error.command.b"]
    assert ex.owner("legs") == "a"


@pytest.mark.parametrize("command", [Walk(0.1), Posture("Stand")])
def test_what_wants_the_legs_ends_a_move_for_it_would_wait_for_ever(command: RobotCommand) -> None:
    ex = walking()
    ex.start("a", Move(0.1))
    ex.advance(0.0)
    ex.start("b", command)
    assert names(ex.advance(0.4)) == []
    assert names(ex.advance(0.5)) == ["done.command.a"]
    assert ex.owner("legs") == "b"


def test_no_move_comes_before_what_waits_for_the_legs_already() -> None:
    ex = walking()
    ex.start("walk", Walk(0.1))
    ex.advance(0.0)
    ex.start("move", Move(0.1))
    ex.start("stand", Posture("Stand"))
    assert names(ex.advance(0.5)) == ["cancelled.command.move"]
    ex.start("again", Move(0.1))
    ex.advance(1.0)
    assert ex.owner("legs") == "stand"


def test_stop_walk_ends_a_move_whatever_came_between() -> None:
    ex = walking()
    ex.start("a", Move(0.1))
    ex.advance(0.0)
    ex.start("s", Stop("walk"))
    ex.start("b", Move(0.1))
    assert names([*ex.advance(0.5), *ex.advance(0.6)]) == ["cancelled.command.a", "done.command.s"]
    assert ex.owner("legs") == "b"
