"""Saved files checked in a separate process, so that they never delay a tick and never end the exhibition.

Python runs one thread at a time. A thread that loads files would delay the exhibition for as long as the system makes
the thread itself wait: some ticks on a busy machine. Of the result only the differences from the known project are
sent, which takes some milliseconds. The child is Lumen's own program, with a private pipe. Files that end the child
would have ended this process, so they are never tried here (docs/decisions/023).
"""

import sys
from collections.abc import Mapping
from contextlib import closing, suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

from lumen.errors import FatalFilesError
from lumen.language.diagnostics import Diagnostic
from lumen.language.projects import Project
from lumen.run.reload.delta import Delta, DeltaDecoder
from lumen.run.reload.idle_process import IdleProcess, keep, take
from lumen.run.reload.known_projects import keep as keep_known
from lumen.run.reload.known_projects import recall
from lumen.run.reload.visits_check import VisitsCheck
from lumen.upkeep.judge_process import ANSWER_TIMEOUT, MAX_MEMORY, Fault, JudgeProcess, NoAnswerError

if TYPE_CHECKING:
    from lumen.run.rehearsal import Rehearsal

COMMAND = [sys.executable, "-m", "lumen.run.reload.validation_process"]
Loaded = tuple[Project | None, tuple[Diagnostic, ...]]
"""A project (None if it has errors), and its diagnostics."""


class FileJudge(Protocol):
    """A checker that loads files, and plays stories and visits."""

    def begin(self) -> None:
        """Prepare to load files soon."""

    def warm(self, files: Mapping[str, bytes]) -> None:
        """Prepare to load files that differ little from these."""

    def load(self, files: Mapping[str, bytes]) -> Loaded:
        """Return the project that the files make, None if they have errors, and all findings in them.

        Raises FatalFilesError if reading them ends the process that does so.
        """

    def play(self, project: Project, story: str, seconds: float) -> "Rehearsal | None":
        """Return how a story fails with the last loaded project; None if it does not fail within `seconds` [s]."""

    def visits(self, project: Project, running: str, budget: float) -> VisitsCheck:
        """Play recorded visits for at most `budget` [s] with the last loaded project; return the result.

        `running` is the hash of the running bundle. Raises FatalFilesError if that ends the process that plays them.
        """

    def close(self) -> None:
        """Release the resources of the checker."""


class ValidationWorker:
    """A `FileJudge` in another process: the idle process that was kept, else a new one on first use.

    A process that died is started again.
    """

    def __init__(self, root: Path, timeout: float = ANSWER_TIMEOUT) -> None:
        self._root, self._timeout = root.absolute(), timeout
        kept = take(tuple(COMMAND)) or IdleProcess(JudgeProcess(COMMAND), DeltaDecoder())
        self._process, self._receiver = kept

    @property
    def packed(self) -> Delta:
        """All pieces of the last loaded project, packed."""
        return self._receiver.packed

    def warm(self, files: Mapping[str, bytes]) -> None:
        """Let a process that has not started read the running files, because later saved files will differ little."""
        if not self._process.started:
            with suppress(FatalFilesError):
                self._load(files)

    def begin(self) -> None:
        """Start the process, which takes about as long as saved files take to settle."""
        with suppress(OSError):
            self._process.start()

    def load(self, files: Mapping[str, bytes]) -> Loaded:
        started = self._process.started
        try:
            return self._load(files)
        except FatalFilesError as error:
            if not started or error.overdue:
                raise
            return self._load(files)  # earlier files may have used up its memory, so try again in a new process

    def play(self, project: Project, story: str, seconds: float) -> "Rehearsal | None":
        try:
            found: Rehearsal | None = self._request("play", story, seconds)
        except FatalFilesError:
            return None
        return found

    def visits(self, project: Project, running: str, budget: float) -> VisitsCheck:
        found: VisitsCheck | None = self._request("visits", str(self._root), running, budget)
        return found or VisitsCheck(trouble="the process that plays them was restarted")

    def close(self) -> None:
        """Keep the process, if it has started, for the next worker."""
        if self._process.started:
            keep(IdleProcess(self._process, self._receiver))
            self._process = JudgeProcess(COMMAND)

    def _load(self, files: Mapping[str, bytes]) -> Loaded:
        parcel, diagnostics = self._request("load", str(self._root), dict(files))
        return (None if parcel is None else self._receiver.unpack(parcel)), diagnostics

    def _request(self, *question: Any) -> Any:
        """Return the process's answer to a question, or raise its error.

        Raises FatalFilesError if the process ends without an answer.
        """
        try:
            self._process.start()
        except OSError as error:
            raise FatalFilesError(f"the process that reads the files can't start: {error.strerror}") from None
        try:
            return self._process.request(question, self._timeout)
        except NoAnswerError as error:
            how = f"the process that reads these files failed: {_how(error, self._timeout)}"
            raise FatalFilesError(how, overdue=error.fault is Fault.LATE) from None


def load_apart(root: Path, files: Mapping[str, bytes]) -> Loaded:
    """Return the project of these files, and their diagnostics, read in a separate process.

    A project that was read before comes from the cache (run/reload/known_projects.py), without its warnings. Raises
    FatalFilesError if the files end the process.
    """
    if project := recall(root, files):
        return project, ()
    with closing(ValidationWorker(root)) as worker:
        loaded = worker.load(files)
        if loaded[0]:
            keep_known(root, files, worker.packed)
        return loaded


def _how(error: NoAnswerError, timeout: float) -> str:
    """Return in words how the process ended."""
    if error.fault is Fault.LATE:
        return f"it took more than {timeout:.0f} s"
    if error.fault is Fault.MEMORY:
        return f"it needed more than {MAX_MEMORY >> 20} MB of memory"
    return f"it was ended by {error.signal}" if error.signal else f"it ended with exit code {error.code}"
