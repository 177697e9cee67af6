"""The progress of a long command: an estimate that counts down, shown only on a terminal and only after a delay."""

import io
import sys
import threading
from itertools import count

import pytest

from lumen.cli import progress as module
from lumen.cli.progress import ProgressState, progress, progress_line
from tests.tables import for_each
from tests.waiting import HANG, until


@for_each(
    ("state", "now", "shown"),
    [
        (ProgressState(5, 20, "wave", at=10.0), 10.0, "[######                  ] 5 of 20 wave, about 0:30 more"),
        (ProgressState(5, 20, "wave", at=10.0), 25.0, "[######                  ] 5 of 20 wave, about 0:15 more"),
        (ProgressState(5, 20, "wave", at=10.0), 99.0, "[######                  ] 5 of 20 wave, 1:39 so far"),
        (ProgressState(0, 20, "wave"), 3.0, "[                        ] 0 of 20 wave"),
        (ProgressState(0, 0, "wave"), 3.0, "wave (0:03 so far)"),
    ],
)
def test_the_estimate_is_by_what_is_done_and_counts_down(state: ProgressState, now: float, shown: str) -> None:
    assert progress_line(state, now) == shown


def test_a_bound_is_said_to_be_one() -> None:
    line = progress_line(ProgressState(1_000, 20_000, "configurations", at=2.0), 2.0, at_most=True)
    assert line.endswith("1,000 of at most 20,000 configurations, at most 0:38 more")


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def test_a_terminal_sees_it_after_a_while_and_nothing_of_it_is_left(monkeypatch: pytest.MonkeyPatch) -> None:
    terminal = Terminal()
    monkeypatch.setattr(sys, "stderr", terminal)
    monkeypatch.setattr(module, "REDRAWING", 0.001)
    monkeypatch.setattr(module, "PATIENCE", 0.001)
    with progress() as tell:
        tell(1, 4, "wave")
        until(lambda: "1 of 4 wave" in terminal.getvalue())
    assert terminal.getvalue().endswith("\r\x1b[K")


def test_what_is_short_shows_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    terminal = Terminal()
    monkeypatch.setattr(sys, "stderr", terminal)
    monkeypatch.setattr(module, "PATIENCE", HANG)
    with progress() as tell:
        tell(1, 4, "wave")
    assert "wave" not in terminal.getvalue()


def test_nothing_is_shown_before_there_is_something_to_tell(monkeypatch: pytest.MonkeyPatch) -> None:
    terminal, looked = Terminal(), count()
    monkeypatch.setattr(sys, "stderr", terminal)
    monkeypatch.setattr(module, "REDRAWING", 0.001)
    monkeypatch.setattr(module, "PATIENCE", 0.0)
    drawn = threading.Event()

    def clock() -> float:
        if next(looked) == 5:
            drawn.set()
        return 0.0

    with progress(clock=clock) as tell:
        assert drawn.wait(HANG)
        assert terminal.getvalue() == ""
        tell(1, 4, "wave")
        until(lambda: "1 of 4 wave" in terminal.getvalue())


def test_a_file_never_sees_it(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "PATIENCE", 0.0)
    with progress() as tell:
        tell(1, 4, "wave")
    assert capsys.readouterr() == ("", "")
