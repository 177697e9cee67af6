"""The process that judged a start is kept for the first saved file, and not for ever."""

import os
import signal
from collections.abc import Iterator
from pathlib import Path

import pytest

from lumen.project.files import read_files
from lumen.run.reload import idle_process
from lumen.run.reload.idle_process import end_idle, take
from lumen.run.reload.validation_worker import COMMAND, ValidationWorker, load_apart
from lumen.upkeep import judge_process
from tests.waiting import UNLIMITED, until

pytestmark = pytest.mark.rest  # expensive

TOUR = "behaviors/tour.yaml"
SORRY = b'en: "I am sorry, I did not understand that."'


@pytest.fixture(autouse=True)
def begun(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Iterator[list[int]]:
    """The numbers of the processes that were begun; no project is known from before."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    monkeypatch.setattr(idle_process, "LINGER", UNLIMITED)
    end_idle()
    numbers, usual = list[int](), judge_process.subprocess.Popen

    def noted(*given: object, **options: object) -> object:
        child = usual(*given, **options)  # type: ignore[call-overload]
        numbers.append(child.pid)
        return child

    monkeypatch.setattr(judge_process.subprocess, "Popen", noted)
    yield numbers
    end_idle()


@pytest.mark.slow
def test_it_judges_the_first_saved_file_and_the_next_start(copy: Path, begun: list[int]) -> None:
    files = read_files(copy)
    started, _ = load_apart(copy, files)
    worker = ValidationWorker(copy)
    assert worker.load({**files, TOUR: files[TOUR].replace(SORRY, b"en: [")})[0] is None
    again, _ = worker.load(files)
    worker.close()
    assert load_apart(copy, files)[0] == again == started
    assert len(begun) == 1


def test_one_that_has_died_or_was_begun_otherwise_is_not_taken(copy: Path, begun: list[int]) -> None:
    worker = ValidationWorker(copy)
    worker.begin()
    worker.close()
    assert take(("another",)) is None
    idle = take(tuple(COMMAND))
    assert idle
    os.kill(begun[-1], signal.SIGKILL)
    until(lambda: not idle.process.alive)
    idle_process.keep(idle)
    assert take(tuple(COMMAND)) is None


def test_nobody_is_given_the_answer_to_a_question_that_was_interrupted(
    copy: Path, begun: list[int], monkeypatch: pytest.MonkeyPatch
) -> None:
    def interrupted(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(judge_process, "receive", interrupted)
    with pytest.raises(KeyboardInterrupt):
        load_apart(copy, read_files(copy))
    assert take(tuple(COMMAND)) is None


def test_it_ends_where_nobody_wants_it(copy: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(idle_process, "LINGER", 0.05)
    worker = ValidationWorker(copy)
    worker.begin()
    process = worker._process
    assert process.alive
    worker.close()
    until(lambda: not process.started)
    assert take(tuple(COMMAND)) is None
