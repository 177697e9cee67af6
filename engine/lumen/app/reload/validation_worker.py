"""Saved files judged in a process of its own, so that they never hold up a tick, and never end the exhibition.

Python runs one thread at a time. A thread that loads files would keep the exhibition waiting for as long as the system
lets it wait itself, some ticks on a busy machine. Of what comes back only that travels which differs from what is here
already: some milliseconds. The child is our own program, and the pipe to it nobody else's. What ends it would have
ended us: it is never tried here (docs/decisions/023).
"""

import pickle
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Mapping
from contextlib import closing, suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

from lumen.app.reload.delta import Delta, DeltaDecoder
from lumen.app.reload.idle_process import JudgingProcess, keep, take
from lumen.app.reload.judging_pipe import ANSWER_TIMEOUT, MAX_MEMORY, OUT_OF_MEMORY, receive, send
from lumen.app.reload.known_projects import keep as keep_known
from lumen.app.reload.known_projects import recall
from lumen.app.reload.visits_check import VisitsCheck
from lumen.errors import FatalFilesError
from lumen.language.diagnostics import Diagnostic
from lumen.language.projects import Project

if TYPE_CHECKING:
    from lumen.app.rehearsal import Rehearsal

COMMAND = [sys.executable, "-m", "lumen.app.reload.validation_process"]
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
        self._process = take(tuple(COMMAND))
        self._receiver = self._process.receiver if self._process else DeltaDecoder()

    @property
    def packed(self) -> Delta:
        """The project that was loaded last, all of it, packed."""
        return self._receiver.packed

    def warm(self, files: Mapping[str, bytes]) -> None:
        """Have a process that was not begun yet read what runs: of files that are saved later one will differ."""
        if self._process is None:
            with suppress(FatalFilesError):
                self._load(files)

    def begin(self) -> None:
        """Begin the process: it takes about as long as files do to settle."""
        with suppress(OSError):
            self._running()

    def load(self, files: Mapping[str, bytes]) -> Loaded:
        began = self._process
        try:
            return self._load(files)
        except FatalFilesError as error:
            if began is None or error.overdue:
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
        process, self._process = self._process, None
        if process:
            keep(process)

    def _load(self, files: Mapping[str, bytes]) -> Loaded:
        parcel, diagnostics = self._ask("load", str(self._root), dict(files))
        return (None if parcel is None else self._receiver.unpack(parcel)), diagnostics

    def _ask(self, *question: Any) -> Any:
        """Its answer; raises what it raised, and FatalFilesError where it did not live to answer."""
        try:
            process = self._running()
        except OSError as error:
            raise FatalFilesError(f"the process that reads the files can't start: {error.strerror}") from None
        child = process.child
        began, timer = time.monotonic(), threading.Timer(self._timeout, child.kill)
        timer.start()
        try:
            assert child.stdin
            assert child.stdout
            send(child.stdin, question)
            answer = receive(child.stdout)
        except (OSError, EOFError, pickle.UnpicklingError):
            self._process = None
            process.end()
            late = time.monotonic() - began >= self._timeout
            how = f"it took more than {self._timeout:.0f} s" if late else _how(child.returncode)
            raise FatalFilesError(f"the process that reads these files failed: {how}", overdue=late) from None
        except BaseException:  # whoever is interrupted leaves an answer in the pipe, which is none to the next question
            self._process = None
            process.end()
            raise
        finally:
            timer.cancel()
        if isinstance(answer, Exception):
            raise answer
        return answer

    def _running(self) -> JudgingProcess:
        """The process, begun anew where there is none; raises OSError where the system has no room for it."""
        if self._process and not self._process.lives:
            self._process.end()
            self._process = None
        if self._process is None:
            command = tuple(COMMAND)
            child = subprocess.Popen(
                command,
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                start_new_session=True,  # Ctrl-C is not for it
            )
            self._process = JudgingProcess(child, command, self._receiver)
        return self._process


def load_apart(root: Path, files: Mapping[str, bytes]) -> Loaded:
    """What these files make, read in a process of its own; raises FatalFilesError where they end it.

    A project that was read before is not read again (app/reload/known_projects.py), nor warned of.
    """
    if project := recall(root, files):
        return project, ()
    with closing(ValidationWorker(root)) as worker:
        loaded = worker.load(files)
        if loaded[0]:
            keep_known(root, files, worker.packed)
        return loaded


def _how(code: int) -> str:
    """How a process ended, by its exit code."""
    if code == OUT_OF_MEMORY:
        return f"it needed more than {MAX_MEMORY >> 20} MB of memory"
    if code < 0:
        with suppress(ValueError):
            return f"it was ended by {signal.Signals(-code).name}"
    return f"it ended with exit code {code}"
