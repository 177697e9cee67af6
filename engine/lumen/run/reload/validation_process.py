"""The process that checks files: `python -m lumen.run.reload.validation_process`, run by a `JudgeProcess`.

Its memory and its time for each question are limited; the operating system ends it if it exceeds them.
"""

import time
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from lumen.language.projects import Project
from lumen.lint import check_files
from lumen.run.reload.delta import DeltaEncoder
from lumen.upkeep.garbage import gc_paused
from lumen.upkeep.heap import give_back
from lumen.upkeep.judge_process import ANSWER_TIMEOUT, MAX_MEMORY, answering

if TYPE_CHECKING:
    from lumen.run.rehearsal import Rehearsal


class EnoughError(Exception):
    """The time for a story has passed."""


def failure(project: Project, story: str, seconds: float) -> "Rehearsal | None":
    """Return how a story fails with a project.

    Return None if the story does not fail, or takes more than `seconds` [s] of real time.
    """
    from lumen.run.rehearsal import rehearse  # half of this process's imports, needed only for stories

    until = time.perf_counter() + seconds

    def hurry(_: float) -> None:
        if time.perf_counter() > until:
            raise EnoughError

    try:
        rehearsal = rehearse(project, project.stories[story], hooks=[hurry])
    except EnoughError:
        return None
    return rehearsal if rehearsal.failed else None


class FileJudgement:
    """Answers to questions about files; `play` and `visits` use the project that was loaded last."""

    def __init__(self) -> None:
        self._project: Project | None = None
        self._sender = DeltaEncoder()

    def answer(self, question: Sequence[Any]) -> Any:
        """Return the answer to a question: a verb with its arguments. None for an unknown question."""
        match question:
            case ["load", str(root), dict(files)]:
                with gc_paused():
                    self._project, diagnostics = check_files(Path(root), files)
                return None if self._project is None else self._sender.pack(self._project), diagnostics
            case ["play", str(story), float(seconds)] if self._project:
                return failure(self._project, story, seconds)
            case ["visits", str(root), str(running), float(budget)] if self._project:
                from lumen.run.reload.visits_check import check_visits  # ninety modules that no start needs

                return check_visits(Path(root), self._project, running, budget)
        return None


def main() -> None:
    """Answer questions until the pipe ends."""
    with answering(MAX_MEMORY) as pipe:
        give_back()
        judgement = FileJudgement()
        for question in pipe:
            pipe.answer(partial(judgement.answer, question), ANSWER_TIMEOUT + 1.0)


if __name__ == "__main__":
    main()
