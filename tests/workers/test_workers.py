"""Tasks for several processes: the results are the same, a worker that dies is reported, and nothing is left behind."""

import os
import re
import signal
import sys
from multiprocessing import active_children
from pathlib import Path

import pytest

from lumen.cli.main import main
from lumen.errors import UsageError, WorkersError
from lumen.run.workers.local_pool import TERMINATED
from lumen.run.workers.tasks import TaskHead, WorkKit, do_task, engine, name_of
from lumen.run.workers.workers import Workers, cores, workers_of
from tests import ROOT
from tests.guarded import PIPE, Guarded
from tests.house.test_guarded import left
from tests.tables import for_each
from tests.waiting import HANG, until
from tests.workers.small_tasks import die, of_sigterm, process, square, square_or_die

KIT = WorkKit({}, {"models/mesh.stl": b"solid"})
TASKS = [(number,) for number in range(6)]


@pytest.mark.once
@pytest.mark.process
@pytest.mark.slow
def test_two_processes_do_what_one_does(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    alone = list(Workers(1).results(square, KIT, TASKS))
    assert alone == [(number, (number**2, b"solid")) for number in range(6)]
    assert sorted(Workers(2).results(square, KIT, TASKS)) == alone
    assert list(tmp_path.iterdir()) == []


def test_one_task_or_one_worker_takes_no_other_process() -> None:
    assert {found for _, found in Workers(1).results(process, KIT, TASKS)} == {os.getpid()}
    assert {found for _, found in Workers(8).results(process, KIT, TASKS[:1])} == {os.getpid()}
    assert list(Workers(8).results(process, KIT, [])) == []


@pytest.mark.process
@pytest.mark.slow
def test_what_a_dead_worker_was_at_is_done_again_and_told(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    tasks = [(number, str(tmp_path / "died")) for number in range(6)]
    assert sorted(Workers(2).results(square_or_die, KIT, tasks)) == [(number, number**2) for number in range(6)]
    beginning = "a worker process ended unexpectedly (it may have run out of memory): repeating "
    (told,) = [message for message in caplog.messages if message.startswith(beginning)]
    assert told.endswith((" tasks", " 1 task"))


@pytest.mark.process
@pytest.mark.slow
def test_a_crew_stays_for_one_round_after_the_other_also_when_one_dies(tmp_path: Path) -> None:
    squares = [(number, number**2) for number in range(6)]
    with Workers(2).crew(square_or_die, KIT, 2) as crew:
        first = sorted(crew.results([(number, str(tmp_path)) for number in range(6)]))  # the marker is there
        there = active_children()
        again = sorted(crew.results([(number, str(tmp_path)) for number in range(6)]))
        assert active_children() == there
        died = sorted(crew.results([(number, str(tmp_path / "died")) for number in range(6)]))
        assert not {*active_children()} & {*there}
    assert first == again == died == squares
    assert active_children() == []


def test_a_crew_of_one_is_this_process() -> None:
    with Workers(1).crew(process, KIT, 5) as crew:
        assert {found for round in range(2) for _, found in crew.results(TASKS)} == {os.getpid()}


@pytest.mark.process
@pytest.mark.slow
def test_workers_that_die_again_are_an_error_in_words(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    with pytest.raises(WorkersError, match=r"for the second time: use fewer workers, such as --workers 1$"):
        list(Workers(2).results(die, KIT, TASKS))
    assert list(tmp_path.iterdir()) == []


WAITING = """
import sys
from lumen.run.workers.tasks import WorkKit
from lumen.run.workers.workers import Workers
from tests.workers.small_tasks import wait_for_ever

if __name__ == "__main__":
    try:
        list(Workers(2).results(wait_for_ever, WorkKit({}, {}), [(n, sys.argv[1]) for n in range(4)]))
    except KeyboardInterrupt:
        sys.exit(130)
"""


@pytest.mark.slow
@pytest.mark.parametrize(
    ("number", "everybody", "code"),
    [
        (signal.SIGINT, True, 130),
        (signal.SIGINT, False, 130),
        (signal.SIGTERM, False, TERMINATED),
        (signal.SIGKILL, False, -signal.SIGKILL),
    ],
    ids=["Ctrl-C", "SIGINT", "SIGTERM", "SIGKILL"],
)
def test_whatever_ends_it_leaves_no_process_and_no_folder(
    number: int, everybody: bool, code: int, tmp_path: Path
) -> None:
    """Four real programs with two workers each: signals can't be tried otherwise."""
    program, began = tmp_path / "program.py", tmp_path / "began"
    program.write_text(WAITING)
    began.mkdir()
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "TMPDIR": str(tmp_path)}
    command = [sys.executable, str(program), str(began)]
    with Guarded(command, env=environment, cwd=tmp_path, stderr=PIPE, text=True) as running:
        until(lambda: len(list(began.iterdir())) >= 2)
        assert list(tmp_path.glob("lumen-work-*"))
        (os.killpg if everybody else os.kill)(running.pid, number)
        _, said = running.communicate(timeout=HANG)
        assert running.returncode == code
        assert not said or number == signal.SIGKILL  # after SIGKILL multiprocessing's own tracker prints its cleanup
    until(lambda: not left(tmp_path))
    assert left(tmp_path) == []


@pytest.mark.process
def test_sigterm_ends_workers_also_where_the_program_ignores_it() -> None:
    before = signal.signal(signal.SIGTERM, signal.SIG_IGN)
    try:
        assert {found for _, found in Workers(2).results(of_sigterm, KIT, TASKS[:2])} == {True}
    finally:
        signal.signal(signal.SIGTERM, before)


def test_a_worker_with_other_software_refuses() -> None:
    packed = KIT.packed()
    with pytest.raises(WorkersError, match="Install the same Lumen"):
        do_task(TaskHead(square, "Lumen of yesterday", name_of(packed)), packed, (1,))
    python = f"Python {sys.version_info.major}.{sys.version_info.minor}"
    assert re.search(rf"^Lumen's code [0-9a-f]{{8}}, {re.escape(python)}, .*lumen-robot 0", engine())


def test_the_same_files_travel_as_the_same_bytes() -> None:
    one = WorkKit({"": {"a": b"1", "b": b"2"}}, {"x": b"", "y": b""})
    other = WorkKit({"": {"b": b"2", "a": b"1"}}, {"y": b"", "x": b""})
    assert one.packed() == other.packed()
    assert name_of(one.packed()) != name_of(KIT.packed())


def test_workers_are_a_number_or_a_cluster() -> None:
    assert workers_of(None).count == cores()
    assert workers_of("3").count == 3
    assert workers_of("dask://[::1]:8786").address == "tcp://[::1]:8786"


@for_each("text", ["0", "-1", "1025", "9" * 5000, "two", "", "dask://", "dask://here", "dask://here:0"])
def test_what_is_neither_is_refused(text: str) -> None:
    with pytest.raises(UsageError):
        workers_of(text)


@pytest.mark.parametrize("words", [["--workers", "2"], ["--physics", "--workers", "many"]])
def test_lint_refuses_workers_that_make_no_sense(words: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["lint", str(ROOT), *words]) == 2
    assert len(capsys.readouterr().err.strip().splitlines()) == 1
