"""The process in which files are judged: `python -m lumen.app.reload.validation_process`, at the end of a pipe.

It is given so much memory and, for each question, so much time; the system ends it where it takes more, whatever it is
at then. Its exit code says that it was the memory.
"""

import os
import signal
import sys
import time
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any

from lumen.app.reload.delta import DeltaEncoder
from lumen.app.reload.judging_pipe import ANSWER_TIMEOUT, MAX_MEMORY, OUT_OF_MEMORY, receive, send
from lumen.language.projects import Project
from lumen.rules import check_files
from lumen.upkeep.garbage import gc_paused
from lumen.upkeep.heap import give_back

if TYPE_CHECKING:
    from lumen.app.rehearsal import Rehearsal

NICENESS = 5
"""By how much the judging process gives way to others on a busy machine, the robot above all (`nice`)."""


class EnoughError(Exception):
    """There is no time left for this story."""


def failure(project: Project, story: str, seconds: float) -> "Rehearsal | None":
    """How a story fails with a project; None where it does not, or not within `seconds` of this machine's time."""
    from lumen.app.rehearsal import rehearse  # half of what this process imports: only where a story is played

    until = time.perf_counter() + seconds

    def hurry(_: float) -> None:
        if time.perf_counter() > until:
            raise EnoughError

    try:
        rehearsal = rehearse(project, project.stories[story], hooks=[hurry])
    except EnoughError:
        return None
    return rehearsal if rehearsal.failed else None


def _serve(question: Sequence[Any], project: Project | None, sender: DeltaEncoder) -> tuple[Any, Project | None]:
    """The answer, and the project that is active after it."""
    match question:
        case ["load", str(root), dict(files)]:
            with gc_paused():
                project, diagnostics = check_files(Path(root), files)
            return (None if project is None else sender.pack(project), diagnostics), project
        case ["play", str(story), float(seconds)] if project:
            return failure(project, story, seconds), project
        case ["visits", str(root), str(running), float(budget)] if project:
            from lumen.app.reload.visits_check import check_visits  # ninety modules that no start needs

            return check_visits(Path(root), project, running, budget), project
    return None, project


def limit_memory(most: int) -> None:
    """Let this process take at most so much [bytes], where the system keeps to that."""
    with suppress(ImportError, OSError, ValueError):  # not everywhere, and nobody may raise what is lower already
        import resource

        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        resource.setrlimit(resource.RLIMIT_AS, (most, most))


def limit_time(seconds: float) -> None:
    """End this process after so long, also where nobody is left who would."""
    if hasattr(signal, "setitimer"):
        signal.setitimer(signal.ITIMER_REAL, seconds)


def main() -> None:
    """Answer until the pipe ends; what anybody prints goes to the terminal, not into the pipe."""
    if hasattr(os, "nice"):
        os.setpriority(os.PRIO_PROCESS, 0, NICENESS)
    limit_memory(MAX_MEMORY)
    give_back()
    answers = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)
    with suppress(EOFError, BrokenPipeError):
        try:
            _answer(answers)
        except MemoryError:
            os._exit(OUT_OF_MEMORY)


def _answer(answers: IO[bytes]) -> None:
    """Answer each question, with an exception where that is what comes of it; raises EOFError at the end."""
    project, sender = None, DeltaEncoder()
    while True:
        limit_time(0.0)
        question = receive(sys.stdin.buffer)
        limit_time(ANSWER_TIMEOUT + 1.0)
        answer: Any
        try:
            answer, project = _serve(question, project, sender)
        except MemoryError:
            raise
        except Exception as error:  # a fault of ours, which costs this answer
            answer = error
        send(answers, answer)


if __name__ == "__main__":
    main()
