"""Saved files judged in a process of its own, so that it never holds up a tick.

Python runs one thread at a time. A thread that loads files would keep the exhibition waiting for as long as the system
lets it wait itself, some ticks on a busy machine. Of what comes back only that travels which differs from what is here
already: some milliseconds. The child is our own program, and the pipe to it nobody else's.
"""

import logging
import os
import pickle
import struct
import subprocess
import sys
import time
from collections.abc import Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import IO, Any

from lumen.app.rehearsal import Rehearsal, rehearse
from lumen.app.reload.delta import DeltaDecoder, DeltaEncoder
from lumen.language.diagnostics import Diagnostic
from lumen.language.projects import Project
from lumen.rules import check_files

_log = logging.getLogger(__name__)
_LENGTH = struct.Struct(">I")
NICENESS = 5
"""By how much the judging process gives way to others on a busy machine, the robot above all (`nice`)."""
Loaded = tuple[Project | None, tuple[Diagnostic, ...]]


class EnoughError(Exception):
    """There is no time left for this story."""


class InlineValidation:
    """Loads files, and plays stories, on the thread that asks."""

    def __init__(self, root: Path) -> None:
        self._root = root

    def begin(self) -> None:
        """Files will have to be loaded soon."""

    def load(self, files: Mapping[str, bytes]) -> Loaded:
        """The project that the files make, None where they have errors, and everything wrong with them."""
        return check_files(self._root, files)

    def play(self, project: Project, story: str, seconds: float) -> Rehearsal | None:
        """How a story fails with the project loaded last; None where it does not, or not within this time."""
        return failure(project, story, seconds)

    def close(self) -> None:
        """Nothing to let go of."""


class ValidationWorker:
    """What `Here` does, in another process; that is begun when it is first needed, and anew where it has died."""

    def __init__(self, root: Path) -> None:
        self._here = InlineValidation(root)
        self._root = root
        self._child: subprocess.Popen[bytes] | None = None
        self._receiver = DeltaDecoder()

    def begin(self) -> None:
        """Begin the process: it takes about as long as files do to settle."""
        with suppress(OSError):
            self._running()

    def load(self, files: Mapping[str, bytes]) -> Loaded:
        try:
            parcel, diagnostics = self._ask("load", str(self._root), dict(files))
        except (OSError, EOFError, pickle.UnpicklingError) as error:
            _log.warning("the process that judges saved files is gone, they are judged beside the robot: %r", error)
            self.close()
            return self._here.load(files)
        return (None if parcel is None else self._receiver.unpack(parcel)), diagnostics

    def play(self, project: Project, story: str, seconds: float) -> Rehearsal | None:
        try:
            found: Rehearsal | None = self._ask("play", story, seconds)
        except (OSError, EOFError, pickle.UnpicklingError):
            self.close()
            return None
        return found

    def close(self) -> None:
        """End the process."""
        child, self._child = self._child, None
        if child:
            child.kill()
            child.communicate()

    def _ask(self, *question: Any) -> Any:
        child = self._running()
        assert child.stdin
        assert child.stdout
        _write(child.stdin, question)
        return _read(child.stdout)

    def _running(self) -> "subprocess.Popen[bytes]":
        """The process, begun anew where there is none; raises OSError where the system has no room for it."""
        if self._child is None or self._child.poll() is not None:
            self.close()
            self._child = subprocess.Popen(
                [sys.executable, "-m", "lumen.app.reload.validation_worker"],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                start_new_session=True,  # Ctrl-C is not for it
            )
        return self._child


def failure(project: Project, story: str, seconds: float) -> Rehearsal | None:
    """How a story fails with a project; None where it does not, or not within `seconds` of this machine's time."""
    until = time.perf_counter() + seconds

    def hurry(_: float) -> None:
        if time.perf_counter() > until:
            raise EnoughError

    try:
        rehearsal = rehearse(project, project.stories[story], hooks=[hurry])
    except EnoughError:
        return None
    return rehearsal if rehearsal.failed else None


def _write(pipe: IO[bytes], what: Any) -> None:
    data = pickle.dumps(what, pickle.HIGHEST_PROTOCOL)
    pipe.write(_LENGTH.pack(len(data)) + data)
    pipe.flush()


def _read(pipe: IO[bytes]) -> Any:
    """What comes next; raises EOFError at the end."""
    head = pipe.read(_LENGTH.size)
    if len(head) < _LENGTH.size:
        raise EOFError
    return pickle.loads(pipe.read(*_LENGTH.unpack(head)))


def _serve(question: Sequence[Any], project: Project | None, sender: DeltaEncoder) -> tuple[Any, Project | None]:
    """The answer, and the project that is active after it."""
    match question:
        case ["load", str(root), dict(files)]:
            project, diagnostics = check_files(Path(root), files)
            return (None if project is None else sender.pack(project), diagnostics), project
        case ["play", str(story), float(seconds)] if project:
            return failure(project, story, seconds), project
    return None, project


def main() -> None:
    """Answer until the pipe ends; what anybody prints goes to the terminal, not into the pipe."""
    if hasattr(os, "nice"):
        os.nice(NICENESS)
    answers = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)
    project, sender = None, DeltaEncoder()
    with suppress(EOFError, BrokenPipeError):
        while True:
            answer, project = _serve(_read(sys.stdin.buffer), project, sender)
            _write(answers, answer)


if __name__ == "__main__":
    main()
