"""Typed input, from people and from programs that never stop."""

from types import SimpleNamespace
from typing import Any
from unittest.mock import Mock

import pytest

from lumen.cli.person import person
from lumen.cli.typed import MAX_LINE_CHARACTERS, MAX_WAITING_LINES, TypedVisitorPart
from lumen.cli.typed_commands import TypedCommands
from lumen.errors import BusError
from lumen.language.routing_keys import default_key
from lumen.upkeep.threads import ThreadWatch
from tests.tables import for_each
from tests.waiting import until


class EndlessInput:
    """Input that has as many characters as are requested, until it `ends`."""

    def __init__(self) -> None:
        self.calls, self.ends = 0, False

    def isatty(self) -> bool:
        return False

    def readline(self, size: int) -> str:
        self.calls += 1
        return "" if self.ends else "a" * size


def test_a_line_without_end_fills_no_memory_and_holds_up_no_tick(monkeypatch: pytest.MonkeyPatch) -> None:
    typed, visitor = EndlessInput(), Mock()
    monkeypatch.setattr("sys.stdin", typed)
    who: Any = SimpleNamespace(needs=(), actor=visitor, environment=Mock())
    part = TypedVisitorPart(who, Mock(), "", lambda: None)
    part.begin(0.0)
    until(lambda: typed.calls == MAX_WAITING_LINES + 1)
    part.tick(0.0, ())
    assert 1 <= visitor.speak.call_count <= MAX_WAITING_LINES
    assert all(len(call.args[0]) == MAX_LINE_CHARACTERS for call in visitor.speak.call_args_list)
    typed.ends = True
    until(lambda: part.tick(1.0, ()) or visitor.leave.called)
    assert not part.over
    part.tick(7.0, ())
    assert part.over


class ClosedTerminal(EndlessInput):
    """A terminal that was closed after one line."""

    def isatty(self) -> bool:
        return True

    def readline(self, size: int) -> str:
        self.calls += 1
        if self.calls > 1:
            raise OSError(5, "Input/output error")
        return "hello"


def test_a_closed_terminal_is_the_end_of_the_visit_and_no_fault(monkeypatch: pytest.MonkeyPatch) -> None:
    terminal, visitor, watch = ClosedTerminal(), Mock(), ThreadWatch()
    monkeypatch.setattr("sys.stdin", terminal)
    who: Any = SimpleNamespace(needs=(), actor=visitor, environment=Mock())
    part = TypedVisitorPart(who, Mock(), "", lambda: None)
    part.begin(0.0)
    until(lambda: part.tick(0.0, ()) or visitor.leave.called)
    assert [call.args for call in visitor.speak.call_args_list] == [("hello",)]
    assert (terminal.calls, watch.tick()) == (2, [])


class Hall:
    """Keeps the touches that it is told of."""

    def __init__(self) -> None:
        self.sensors, self.felt = ("FrontTactil", "LeftBumper"), list[tuple[str, bool]]()

    def touch(self, sensor: str, pressed: bool) -> None:
        self.felt.append((sensor, pressed))


def test_a_hand_stays_as_long_as_was_typed() -> None:
    visitor: Any = Hall()
    commands = TypedCommands(visitor, Mock(), Mock())
    commands.do("/touch head", 0.0)
    commands.do("/touch left bumper 2s", 0.0)
    commands.do("/touch LEFTBUMPER 3s", 0.0)
    assert visitor.felt == [("FrontTactil", True), ("LeftBumper", True)]
    commands.tick(0.4)
    assert len(visitor.felt) == 2
    commands.tick(0.5)
    assert visitor.felt[2:] == [("FrontTactil", False)]
    commands.tick(2.9)
    commands.tick(3.0)
    assert visitor.felt[3:] == [("LeftBumper", False)]


@for_each(
    ("line", "says"),
    [
        ("/tuch head", "no command `/tuch`: did you mean `touch`?"),
        ("/", "there are `go`, `help`, `press`, `resume`, `stay`, `stop`, `touch`"),
        ("/go", "True by the operator"),
        ("/stay", "False by the operator"),
        ("/press", "write the button's label, as in `/press Next exhibit`"),
        ("/press Next exhibit", "no Next exhibit for the operator"),
        ("/touch", "name a place, as in `/touch head`"),
        (
            "/touch heda 2s",
            "the robot has no place `heda` to touch: did you mean `head`? there are `head`, `left bumper`",
        ),
        ("/touch chest", "the robot has no place `chest` to touch"),
        ("/help", "/touch head       touch the robot's head; also left bumper"),
        ("/help", "/stop             make the robot rest at once"),
        ("/help", "/resume           let a stopped robot move again"),
    ],
)
def test_what_can_be_typed_is_said(line: str, says: str) -> None:
    visitor: Any = Hall()
    narrator = Mock()
    exhibition = Mock(press=lambda label, by: f"no {label} for {by}", approve=lambda by, *, go: f"{go} by {by}")
    TypedCommands(visitor, narrator, exhibition).do(line, 0.0)
    assert says in narrator.note.call_args.args[0]
    assert visitor.felt == []


def hall() -> SimpleNamespace:
    """Return a project without routes of its own."""
    return SimpleNamespace(routes={}, robot="NAO", key_of=lambda route: default_key(route, "NAO"))


def test_stop_and_resume_go_the_way_of_lumen_stop_in_the_name_of_the_person_who_typed() -> None:
    visitor: Any = Hall()
    exhibition = Mock(project=hall())
    commands = TypedCommands(visitor, Mock(), exhibition)
    commands.do("/stop", 0.0)
    commands.do("/resume", 0.0)
    sent = [(call.args[0], call.args[1]["method"]) for call in exhibition.bus.publish.call_args_list]
    assert sent == [(default_key("stop", "NAO"), "rest"), (default_key("stop", "NAO"), "resume")]
    assert exhibition.bus.publish.call_args.args[1]["parameter"] == {"by": person()}


def test_a_stop_that_the_bus_refuses_is_reported() -> None:
    visitor: Any = Hall()
    narrator, exhibition = Mock(), Mock(project=hall())
    exhibition.bus.publish.side_effect = BusError("the broker is away")
    TypedCommands(visitor, narrator, exhibition).do("/stop", 0.0)
    narrator.note.assert_called_once_with("the robot did not get this command: the broker is away")
