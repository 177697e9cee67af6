"""The check of saved files: loaded, linted, compared with the running bundle, and played on the recording robot."""

import logging
import threading
import time
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import PurePosixPath

from lumen.errors import FatalFilesError
from lumen.insight.changes import Change, Risk, changes
from lumen.language.diagnostics import Diagnostic
from lumen.language.projects import Project
from lumen.language.replay_check import ReplayCheck
from lumen.language.stories import Story
from lumen.project.files import fingerprint
from lumen.project.project_folders import STORIES
from lumen.run.rehearsal import Rehearsal
from lumen.run.reload.requests import ReloadRequest
from lumen.run.reload.validation_worker import FileJudge
from lumen.run.reload.visits_check import VisitsCheck
from lumen.run.watcher import SavedFiles
from lumen.statechart.compiled_machine import prepare

_log = logging.getLogger(__name__)

BUDGET = 2.0
"""The time for playing the saved stories, all together [s]."""


@dataclass(frozen=True)
class Validation:
    """The result of checking saved files: a bundle, or the faults in them."""

    saved: SavedFiles
    """The files that were checked."""
    hash: str
    """The hash of these files; empty if the check failed before the hash was known."""
    project: Project | None = None
    """The bundle of these files; None if they have errors."""
    diagnostics: tuple[Diagnostic, ...] = ()
    """The findings of lint."""
    running: Project | None = None
    """The bundle that ran during the check; None if the check did not get so far."""
    changes: tuple[Change, ...] = ()
    """The changes from `running`."""
    failed: tuple[Rehearsal, ...] = ()
    """The stories that were saved together with these files and fail."""
    fault: str = ""
    """A fault that prevented the check, in words; empty if there was none."""
    loading: float = 0.0
    """The time for loading [s]."""
    playing: float = 0.0
    """The time for playing stories [s]."""
    visits: VisitsCheck | None = None
    """The result for recorded visits; None if they were not played."""
    replaying: float = 0.0
    """The time for playing visits [s]."""

    @property
    def objects(self) -> bool:
        """Whether a person must confirm the files, because a recorded visit would change."""
        return self.visits is not None and self.visits.objects

    @property
    def good(self) -> bool:
        """Whether the files make a bundle, and no story or check failed; recorded visits do not count."""
        return self.project is not None and not self.failed and not self.fault

    @property
    def took(self) -> float:
        """The time for the whole check [s], without the quiet period."""
        return self.loading + self.playing + self.replaying

    def kept(self) -> "Validation":
        """Return a copy without the files and the projects, which take much memory."""
        return replace(self, saved=self.saved._replace(files={}), project=None, running=None)


class BundleValidator:
    """A checker of files against the bundle that `running` returns; call it on threads that need not answer soon.

    `worker` loads files and plays stories in another process. Only one thread at a time uses it, because it plays the
    stories of the project that it loaded last.
    """

    def __init__(self, worker: FileJudge, running: Callable[[], Project], budget: float = BUDGET) -> None:
        self._worker, self._running, self._budget = worker, running, budget
        self._turn, self._loaded = threading.Lock(), ""

    def __call__(self, saved: SavedFiles) -> Validation:
        """Return the result of checking saved files; errors in them do not raise."""
        with self._turn:
            return self._validate(saved)

    def warm(self, files: Mapping[str, bytes]) -> None:
        """Prepare to check files that differ little from these, the running ones."""
        with self._turn:
            self._worker.warm(files)

    def _validate(self, saved: SavedFiles) -> Validation:
        hash, began = "", time.perf_counter()
        try:
            hash = fingerprint(saved.files)
            project, diagnostics = self._worker.load(saved.files)
            self._loaded = hash
            if project is None:
                return Validation(saved, hash, None, diagnostics, loading=time.perf_counter() - began)
            prepare(project.machine)
            running = self._running()
            found = changes(running, project)
            loaded = time.perf_counter()
            failed = tuple(self._play(project, _saved_stories(project, saved.changed)))
            played = time.perf_counter()
            given = isinstance(saved.asked, ReloadRequest) and saved.asked.between
            visits = None if failed else self._replayed(running, project, found, always=given)
            took = loaded - began, played - loaded, visits, time.perf_counter() - played
            return Validation(saved, hash, project, diagnostics, running, found, failed, "", *took)
        except FatalFilesError as error:
            return Validation(saved, hash, fault=str(error))
        except Exception as error:  # an internal error fails only the reload
            return Validation(saved, hash, fault=fault_of(error))

    def _replayed(
        self, running: Project, project: Project, found: Iterable[Change], *, always: bool = False
    ) -> VisitsCheck | None:
        """Return the result for recorded visits; None if none is wanted. An internal error does not fail the reload."""
        check = running.section(ReplayCheck)
        if always and not check.mode:
            check = ReplayCheck("warn")
        if not check.mode or all(change.risk is Risk.COSMETIC and change.kind != "text" for change in found):
            return None
        try:
            visits = self._worker.visits(project, running.hash, check.budget)
        except FatalFilesError as error:
            visits = VisitsCheck(trouble=str(error))
        except Exception as error:
            visits = VisitsCheck(trouble=fault_of(error))
        return replace(visits, mode=check.mode, budget=check.budget)

    def advise(self, validation: Validation, urgent: Callable[[], bool]) -> list[Rehearsal]:
        """Return the failures of other stories of the changed behaviours.

        The check stops when `urgent` returns True or the time is used up. The result is empty if other files were
        loaded since.
        """
        if not validation.good or validation.project is None:
            return []
        others = _touched_stories(validation.project, validation.changes, validation.saved.changed)
        with self._turn:
            return list(self._play(validation.project, others, urgent)) if self._loaded == validation.hash else []

    def _play(
        self, project: Project, stories: Iterable[Story], urgent: Callable[[], bool] = lambda: False
    ) -> Iterator[Rehearsal]:
        """Yield the stories that fail; stories for which no time is left are skipped."""
        until = time.perf_counter() + self._budget
        for story in stories:
            left = until - time.perf_counter()
            if left <= 0.0 or urgent():
                return
            if failed := self._worker.play(project, story.name, left):
                yield failed


def _saved_stories(project: Project, changed: Iterable[str]) -> list[Story]:
    names = [PurePosixPath(path).stem for path in changed if str(PurePosixPath(path).parent) == STORIES]
    return [project.stories[name] for name in names if name in project.stories]


def _touched_stories(project: Project, found: Iterable[Change], changed: Iterable[str]) -> list[Story]:
    """Return the stories of changed behaviours, or all if movements or routes changed.

    The project's story comes first, then the others by length.
    """
    saved = _saved_stories(project, changed)
    files = {change.file for change in found if change.risk is not Risk.COSMETIC or change.kind == "text"}
    behaviors = {PurePosixPath(file).stem for file in files if file.startswith("behaviors/")}
    everything = any(change.risk in (Risk.MOTION, Risk.WIRING) for change in found)
    touched = [
        story
        for story in project.stories.values()
        if story not in saved and (everything or (story.behavior or project.behavior) in behaviors)
    ]
    return sorted(touched, key=lambda story: (story.name != project.story, len(story.steps)))


def told(rehearsal: Rehearsal) -> str:
    """Return a failure in one line, with its place."""
    place = f"{rehearsal.place}: " if rehearsal.place else ""
    failed = rehearsal.failed
    return f"{place}{failed.what if failed else ''}"


def fault_of(error: Exception) -> str:
    """Log an internal error with its traceback, and return a sentence about it."""
    _log.error("Lumen failed on the saved files", exc_info=error)
    return f"an error in Lumen prevented the check of these files: {error!r}"
