"""What is typed, by people and by programs that never stop."""

from types import SimpleNamespace
from typing import Any
from unittest.mock import Mock

import pytest

from lumen.cli.typed import MAX_LINE_CHARACTERS, MAX_WAITING_LINES, TypedVisitorPart
from tests.waiting import until


class EndlessInput:
    """Gives as many characters as it is asked for, until it `ends`."""

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
    who: Any = SimpleNamespace(needs=(), actor=visitor)
    part = TypedVisitorPart(who, Mock(), "")
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
