"""A robot that a person stopped moves only after a person releases it, and it reports who stopped it."""

from pathlib import Path
from typing import Any

import pytest

import lumen
from lumen.language.commands import Leds, Look, Posture, Rest, Say, Wake, Walk
from lumen.language.events import Event
from lumen.ports import Aim, RobotCommand
from lumen.robot.command_receiver import STOPPED_AGAIN, CommandListener
from lumen.robot.person_hold import HoldListener, PersonHold
from lumen.run.parts.kept_hold import KeptHold, forget_hold
from tests.server.stand import Stand
from tests.tables import for_each
from tests.waiting import Collector

MOVING: tuple[RobotCommand, ...] = (
    Wake(),
    Posture("Stand"),
    Walk(0.1, 0.0, 0.0),
    Look(0.1, 0.0),
    Aim({"HeadYaw": 0.1}),
)
STILL: tuple[RobotCommand, ...] = (Rest(), Say("I have stopped", "en"), Leds({"eyes": "red"}))
HAND = Event("touched", {"sensor": "MiddleTactil"})


class Told(CommandListener):
    def __init__(self) -> None:
        self.events: list[Event] = []

    def noticed(self, event: Event) -> None:
        self.events.append(event)


def held_again(folder: Path, *listeners: HoldListener) -> PersonHold:
    """Return the hold of a run after other runs that kept theirs in this folder."""
    kept = KeptHold(folder)
    hold = PersonHold(kept, *listeners)
    kept.restore(hold)
    return hold


@pytest.mark.parametrize("behavior", [True, False])
def test_what_moves_it_is_refused_and_the_rest_is_not(behavior: bool) -> None:
    hold = PersonHold()
    assert [hold.admit(command, behavior=behavior) for command in MOVING] == [""] * len(MOVING)
    hold.stop("Ada")
    for command in MOVING:
        assert hold.admit(command, behavior=behavior) == "Ada stopped the robot: hold its head, or run `lumen resume`"
    assert [hold.admit(command, behavior=behavior) for command in STILL] == [""] * len(STILL)
    hold.release("Bo")
    assert hold.admit(Wake(), behavior=behavior) == ""


def test_a_hand_on_the_head_after_the_stop_lets_the_behaviour_move_it_and_nobody_else() -> None:
    hold = PersonHold()
    hold.feel(HAND)
    hold.stop("Ada")
    assert hold.admit(Wake(), behavior=True)
    for event in (Event("touched", {"sensor": "RightBumper"}), Event("touched"), Event("released", {"sensor": "x"})):
        hold.feel(event)
        assert hold.admit(Wake(), behavior=True)
    hold.feel(HAND)
    assert hold.admit(Wake(), behavior=False)
    assert hold.admit(Wake(), behavior=True) == ""
    assert hold.stopped is None
    assert hold.admit(Wake(), behavior=False) == ""


def test_while_the_behaviour_lets_it_rest_only_the_behaviour_moves_it() -> None:
    hold = PersonHold()
    hold.admit(Rest(), behavior=False)
    assert hold.admit(Wake(), behavior=False) == ""
    hold.admit(Rest(), behavior=True)
    assert (
        hold.admit(Wake(), behavior=False) == "the behaviour lets the robot rest: hold its head, or run `lumen resume`"
    )
    assert hold.admit(Wake(), behavior=True) == ""
    assert hold.admit(Wake(), behavior=False) == ""


def test_it_is_kept_until_somebody_lets_it_move(tmp_path: Path) -> None:
    told = Told()
    first = held_again(tmp_path)
    first.stop("Ada")
    second = held_again(tmp_path, told)
    assert second.stopped == first.stopped
    assert told.events == [Event("stop", {"by": "Ada"})]
    second.release("Bo")
    third = held_again(tmp_path)
    assert third.stopped is None
    third.stop("Ada")
    forget_hold(tmp_path)
    assert held_again(tmp_path).stopped is None


@for_each("content", [b"", b"{", b"[]", b'{"by": 1, "since": 2}', b'{"by": "x", "since": "now"}', b"\xff"])
def test_a_damaged_file_stops_nobody(content: bytes, tmp_path: Path) -> None:
    (tmp_path / "stopped.json").write_bytes(content)
    assert held_again(tmp_path).stopped is None


def ask(stand: Stand, key: str, method: str, **parameter: Any) -> Any:
    answers = Collector()
    undo = stand.bus.subscribe("answers", answers)
    stand.bus.publish(key, {"type": "motion", "method": method, "parameter": parameter}, reply_to="answers")
    stand.live(0.04)
    undo()
    return answers.messages[-1].body if answers.messages else None


def test_over_the_bus_it_is_stopped_asked_and_let_go_on() -> None:
    told = Told()
    stand = Stand(None, told)
    assert ask(stand, "avatar.NAO.stop", "stopped") == {"stopped_by": "", "since": ""}
    ask(stand, "avatar.NAO.stop", "rest", by="Ada")
    assert [command for _, command in stand.robot.started] == [Rest("Ada")]
    assert ask(stand, "avatar.NAO.stop", "stopped")["stopped_by"] == "Ada"
    refused = ask(stand, "avatar.NAO.command", "wakeUp")
    assert refused == "command failed: Ada stopped the robot: hold its head, or run `lumen resume`"
    aim = {"type": "motion", "method": "setAngles", "parameter": {"jointNames": ["HeadYaw"], "angles": [0.1]}}
    stand.bus.publish("avatar.NAO.aim", aim)
    stand.live(0.04)
    assert len(stand.robot.started) == 1
    assert ask(stand, "avatar.NAO.stop", "resume", by="Bo") == "command finished"
    assert told.events == [Event("stop", {"by": "Ada"}), Event("resume", {"by": "Bo"})]
    assert [command for _, command in stand.robot.started][1:] == [Wake()]  # this behaviour knows no `resume`
    stand.server.close()


@for_each("stop", ["rest", "stop"])
def test_a_resume_does_not_undo_a_stop_that_came_right_after_it(stop: str) -> None:
    stand, answers = Stand(), Collector()
    ask(stand, "avatar.NAO.stop", "rest", by="Ada")
    stand.bus.subscribe("answers", answers)
    for method, by in [("resume", "Bo"), (stop, "Cy")]:  # both before the robot's next tick
        body = {"type": "motion", "method": method, "parameter": {"by": by}}
        stand.bus.publish("avatar.NAO.stop", body, reply_to="answers")
    stand.live(0.04)
    assert f"command failed: {STOPPED_AGAIN}" in answers.bodies
    assert ask(stand, "avatar.NAO.stop", "stopped")["stopped_by"] == "Ada"
    assert Wake() not in [command for _, command in stand.robot.started]
    assert ask(stand, "avatar.NAO.stop", "resume", by="Bo") == "command finished"
    assert ask(stand, "avatar.NAO.stop", "stopped")["stopped_by"] == ""
    stand.server.close()


def test_a_modules_rest_is_nobodys_stop() -> None:
    stand = Stand()
    ask(stand, "avatar.NAO.command", "rest")
    ask(stand, "avatar.NAO.command", "wakeUp")
    assert [command for _, command in stand.robot.started] == [Rest(), Wake()]
    stand.server.close()


@pytest.mark.slow
def test_an_exhibition_that_a_program_stopped_waits_for_it() -> None:
    with lumen.open(robot="recording") as exhibition:
        exhibition.run(seconds=2)
        exhibition.stop()
        exhibition.run(seconds=600)
        assert "stopped" in exhibition.configuration
        exhibition.resume()
        exhibition.run(seconds=10)
        assert "watching" in exhibition.configuration
