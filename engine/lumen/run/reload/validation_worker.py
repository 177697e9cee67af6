"""Saved files judged in a process of its own, so that they never hold up a tick, and never end the exhibition.

Python runs one thread at a time. A thread that loads files would keep the exhibition waiting for as long as the system
lets it wait itself, some ticks on a busy machine. Of what comes back only that travels which differs from what is here
already: some milliseconds. The child is our own program, and the pipe to it nobody else's. What ends it would have
ended us: it is never tried here (docs/decisions/023).
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


class FileJudge(Protocol):
    """Loads files, and plays stories."""

    def begin(self) -> None:
        """Files will have to be loaded soon."""

    def warm(self, files: Mapping[str, bytes]) -> None:
        """Files that differ little from these may have to be loaded."""

    def load(self, files: Mapping[str, bytes]) -> Loaded:
        """The project that the files make, None where they have errors, and everything wrong with them.

        Raises FatalFilesError where reading them ends whoever reads them.
        """

    def play(self, project: Project, story: str, seconds: float) -> "Rehearsal | None":
        """How a story fails with the project loaded last; None where it does not, or not within this time."""

    def visits(self, project: Project, running: str, budget: float) -> VisitsCheck:
        """What comes of playing recorded visits, for so long [s], with the project loaded last.

        `running` is the hash of the bundle that runs. Raises FatalFilesError where that ends whoever plays them.
        """

    def close(self) -> None:
        """Let go of what it needs."""


class ValidationWorker:
    """A `FileJudge` in another process: the one that was kept, else one begun when it is first needed.

    It is begun anew where it has died.
    """

    def __init__(self, root: Path, timeout: float = ANSWER_TIMEOUT) -> None:
        self._root, self._timeout = root.absolute(), timeout
        kept = take(tuple(COMMAND)) or IdleProcess(JudgeProcess(COMMAND), DeltaDecoder())
        self._process, self._receiver = kept

    @property
    def packed(self) -> Delta:
        """The project that was loaded last, all of it, packed."""
        return self._receiver.packed

    def warm(self, files: Mapping[str, bytes]) -> None:
        """Have a process that was not begun yet read what runs: of files that are saved later one will differ."""
        if not self._process.started:
            with suppress(FatalFilesError):
                self._load(files)

    def begin(self) -> None:
        """Begin the process: it takes about as long as files do to settle."""
        with suppress(OSError):
            self._process.start()

    def load(self, files: Mapping[str, bytes]) -> Loaded:
        started = self._process.started
        try:
            return self._load(files)
        except FatalFilesError as error:
            if not started or error.overdue:
                raise
            return self._load(files)  # what it had judged before may have been too much, and not these

    def play(self, project: Project, story: str, seconds: float) -> "Rehearsal | None":
        try:
            found: Rehearsal | None = self._ask("play", story, seconds)
        except FatalFilesError:
            return None
        return found

    def visits(self, project: Project, running: str, budget: float) -> VisitsCheck:
        found: VisitsCheck | None = self._ask("visits", str(self._root), running, budget)
        return found or VisitsCheck(trouble="the process that plays them was restarted")

    def close(self) -> None:
        """Have the process kept for who needs one soon."""
        if self._process.started:
            keep(IdleProcess(self._process, self._receiver))
            self._process = JudgeProcess(COMMAND)

    def _load(self, files: Mapping[str, bytes]) -> Loaded:
        parcel, diagnostics = self._ask("load", str(self._root), dict(files))
        return (None if parcel is None else self._receiver.unpack(parcel)), diagnostics

    def _ask(self, *question: Any) -> Any:
        """Its answer; raises what it raised, and FatalFilesError where it did not live to answer."""
        try:
            self._process.start()
        except OSError as error:
            raise FatalFilesError(f"the process that reads the files can't start: {error.strerror}") from None
        try:
            return self._process.ask(question, self._timeout)
        except NoAnswerError as error:
            how = f"the process that reads these files failed: {_how(error, self._timeout)}"
            raise FatalFilesError(how, overdue=error.fault is Fault.LATE) from None


def load_apart(root: Path, files: Mapping[str, bytes]) -> Loaded:
    """What these files make, read in a process of its own; raises FatalFilesError where they end it.

    A project that was read before is not read again (run/reload/known_projects.py), nor warned of.
    """
    if project := recall(root, files):
        return project, ()
    with closing(ValidationWorker(root)) as worker:
        loaded = worker.load(files)
        if loaded[0]:
            keep_known(root, files, worker.packed)
        return loaded


def _how(error: NoAnswerError, timeout: float) -> str:
    """How the process ended, as a sentence."""
    if error.fault is Fault.LATE:
        return f"it took more than {timeout:.0f} s"
    if error.fault is Fault.MEMORY:
        return f"it needed more than {MAX_MEMORY >> 20} MB of memory"
    return f"it was ended by {error.signal}" if error.signal else f"it ended with exit code {error.code}"
