"""Closed, full and unread output (`lumen … | head`): a command prints at most one line; a show ends only if unread."""

import os
import sys
from io import StringIO
from pathlib import Path

import pytest

import lumen
from lumen.cli.agreeing import agrees
from lumen.cli.main import main
from lumen.cli.printing import show
from lumen.cli.transcript import Transcript
from lumen.errors import UsageError
from tests import ROOT
from tests.cli.conftest import Terminal
from tests.copying import copied_project
from tests.guarded import DEVNULL, PIPE, Guarded
from tests.waiting import HANG


class Unread(StringIO):
    """A pipe whose reader is gone."""

    def write(self, text: str) -> int:
        raise BrokenPipeError


class Full(StringIO):
    """A file on a disk that is full."""

    def write(self, text: str) -> int:
        raise OSError(28, "No space left on device")


def called(*words: str, stdout: int, stderr: int = PIPE, folder: Path = ROOT) -> tuple[int, str]:
    command = [sys.executable, "-m", "lumen.cli.main", *words]
    with Guarded(command, cwd=folder, stdin=DEVNULL, stdout=stdout, stderr=stderr, text=True) as process:
        said = process.communicate(timeout=HANG)[1]
    return process.returncode, said or ""


@pytest.fixture
def unread() -> int:
    reader, writer = os.pipe()
    os.close(reader)
    return writer


@pytest.mark.parametrize(
    "words",
    [
        ("lint",),
        ("schema", "lumen"),
        ("explain", "unknown-state"),
        ("export", "asyncapi"),
        ("run", "--help"),
        ("run", "--robot", "recording", "--speed", "max", "--story", "visitor"),
    ],
    ids=" ".join,
)
def test_a_verb_whose_output_nobody_reads_says_nothing(unread: int, words: tuple[str, ...], tmp_path: Path) -> None:
    folder = copied_project(ROOT / "examples/minimal", tmp_path / "minimal")
    assert called(*words, stdout=unread, folder=folder) == (0, "")


def test_an_error_that_nobody_reads_is_one_all_the_same(unread: int) -> None:
    assert called("lint", "nowhere", stdout=DEVNULL, stderr=unread)[0] == 2


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="Linux has a device that is always full")
@pytest.mark.parametrize("words", [("schema", "lumen"), ("explain", "unknown-state")], ids=" ".join)
def test_a_full_disk_is_one_line(words: tuple[str, ...]) -> None:
    with open("/dev/full", "wb") as full:
        code, said = called(*words, stdout=full.fileno())
    assert code == 2
    assert said.count("\n") == 1
    assert "no space left on device" in said


def test_findings_that_nobody_reads_are_lost_and_a_full_disk_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "stdout", Unread())
    show("a finding")
    monkeypatch.setattr(sys, "stdout", Full())
    with pytest.raises(UsageError, match="can't print: no space left on device"):
        show("a finding")


def test_a_stream_that_the_shell_closed_is_none(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "stdout", None)
    monkeypatch.setattr(sys, "stderr", None)
    assert main(["explain", "unknown-state"]) == 0
    assert main(["explain", "nothing-known"]) == 2


def test_nothing_to_say_and_a_name_that_no_system_takes_are_one_line(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["say", " "]) == 2
    assert "the text is empty" in capsys.readouterr().err
    assert main(["test", "a" * 300]) == 2
    assert "a name is too long for this system" in capsys.readouterr().err


@pytest.mark.parametrize("words", [["lint"], ["graph"], ["status"], ["language", "list"]], ids=" ".join)
def test_a_working_directory_that_is_gone_is_one_line(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], words: list[str]
) -> None:
    gone = tmp_path / "gone"
    gone.mkdir()
    monkeypatch.chdir(gone)
    gone.rmdir()
    assert main(words) == 2
    assert capsys.readouterr().err == f"lumen {words[0]}: the current folder no longer exists: `cd` to another one\n"


def test_a_question_that_is_not_answered_is_a_no(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("sys.stdin", Terminal(""))
    assert not agrees("Go?", "say --yes")
    monkeypatch.setattr("sys.stdin", None)
    with pytest.raises(UsageError, match="say --yes"):
        agrees("Go?", "say --yes")


def test_no_verb_at_all_prints_the_help(capsys: pytest.CaptureFixture[str]) -> None:
    assert main([]) == 2
    assert "start a project of your own" in capsys.readouterr().out


@pytest.mark.parametrize(("stream", "ends"), [(Unread(), True), (Full(), False)], ids=["unread", "full"])
def test_a_show_ends_where_nobody_reads_on_and_goes_on_where_the_disk_is_full(stream: StringIO, ends: bool) -> None:
    project = lumen.load(ROOT)
    told: list[str] = []
    transcript = Transcript(lambda: 0.0, lambda: project.machine, stream, unread=lambda: told.append("unread"))
    transcript.line("state", "idle")
    transcript.note("a line")
    assert bool(told) == ends
