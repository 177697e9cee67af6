"""The process that judges files: it serves one thread at a time; if it can't begin, it is tried once more."""

import errno
import os
import threading
from collections.abc import Mapping
from dataclasses import replace
from math import inf
from pathlib import Path
from types import SimpleNamespace

import pytest

import lumen
from lumen.errors import FatalFilesError
from lumen.language.projects import Project
from lumen.language.stories import Expect, Story, StoryPause, StoryStep
from lumen.lint import check_files
from lumen.project.files import read_files
from lumen.run.rehearsal import Rehearsal
from lumen.run.reload import validation_worker
from lumen.run.reload.validation_process import failure
from lumen.run.reload.validation_worker import Loaded, ValidationWorker
from lumen.run.reload.validator import BundleValidator
from lumen.run.reload.visits_check import VisitsCheck
from lumen.run.watcher import SavedFiles
from tests import ROOT
from tests.waiting import until


class Turn:
    """A lock that counts the attempts to acquire it."""

    def __init__(self) -> None:
        self.asked, self._lock = 0, threading.Lock()

    def __enter__(self) -> None:
        self.asked += 1
        self._lock.acquire()

    def __exit__(self, *_: object) -> None:
        self._lock.release()


class SlowJudge:
    """Judges until a second judgement starts; counts the most that ran at once."""

    def __init__(self) -> None:
        self.most, self.turn, self._count = 0, Turn(), threading.Lock()
        self._now = 0

    def begin(self) -> None: ...

    def warm(self, files: Mapping[str, bytes]) -> None: ...

    def close(self) -> None: ...

    def load(self, files: Mapping[str, bytes]) -> Loaded:
        with self._count:
            self._now += 1
            self.most = max(self.most, self._now)
        until(lambda: self.turn.asked == 2 or self.most == 2, what="another who asks meanwhile")
        found = check_files(ROOT, files)
        with self._count:
            self._now -= 1
        return found

    def play(self, project: Project, story: str, seconds: float) -> Rehearsal | None:
        return None

    def visits(self, project: Project, running: str, budget: float) -> VisitsCheck:
        return VisitsCheck()


def test_two_threads_are_judged_one_after_the_other() -> None:
    judge, project = SlowJudge(), lumen.load(ROOT)
    validator, found = BundleValidator(judge, lambda: project), list[bool]()
    validator._turn = judge.turn  # type: ignore[assignment]
    saved = SavedFiles(read_files(ROOT), (), 0.0, 0.0, None)
    threads = [threading.Thread(target=lambda: found.append(validator(saved).good)) for _ in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert found == [True, True]
    assert judge.most == 1


def test_a_story_that_takes_too_long_is_no_failure() -> None:
    steps = StoryStep(Expect(("nowhere",), within=1.0)), StoryStep(StoryPause(1.0))
    stories = {name: Story(name, name, steps[at:]) for at, name in enumerate(("failing", "well"))}
    project = replace(lumen.load(ROOT), stories=stories)
    found = failure(project, "failing", inf)
    assert found
    assert found.failed
    assert found.failed.step == 1
    assert failure(project, "failing", -1.0) is None
    assert failure(project, "well", inf) is None


def test_a_process_that_can_not_begin_in_place_of_another_is_tried_once_more(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(validation_worker, "take", lambda command: None)
    worker, tried = ValidationWorker(tmp_path), list[None]()

    def start() -> None:
        tried.append(None)
        raise BlockingIOError(errno.EAGAIN, os.strerror(errno.EAGAIN))

    monkeypatch.setattr(worker, "_process", SimpleNamespace(started=True, start=start))
    with pytest.raises(FatalFilesError, match="can't start: Resource temporarily unavailable"):
        worker.load({})
    assert len(tried) == 2
