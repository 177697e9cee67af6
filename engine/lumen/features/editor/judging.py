"""Checks projects in a separate process, because Python runs one thread at a time and answers must not wait."""

import asyncio
import os
import sys
import traceback
from functools import partial
from queue import SimpleQueue

from lumen.features.editor.analysis import Analysis, Judgement
from lumen.upkeep.judge_process import AnswerPipe, JudgeProcess, NoAnswerError, answering
from lumen.upkeep.threads import WatchedThread

COMMAND = (sys.executable, "-P", "-m", "lumen.features.editor.judging")
"""The command of the process. `-P` prevents imports from the folder in which the editor started the server."""


class Judge:
    """Checks one project at a time in a separate process, and ends a check as soon as there is a newer text.

    The process starts with the first request, and again after a check that ended it.
    """

    def __init__(self) -> None:
        self._process = JudgeProcess(COMMAND)
        self._number = 0
        self._current = False

    async def judge(self, analysis: Analysis) -> Judgement | None:
        """Return a project's findings; None if a newer request arrived during the check, or if the process ended."""
        self.outdated()
        self._current = True
        question = self._number, analysis
        self._process.start()
        try:
            found: Judgement | None = await asyncio.to_thread(self._process.request, question)
        except NoAnswerError:
            return None
        return found

    def outdated(self) -> None:
        """End the check in progress, if any, because its text is outdated."""
        self._number += 1
        if self._current:  # the process may still be reading the request, so the event loop must not wait for it
            self._current = False
            asyncio.get_running_loop().run_in_executor(None, self._process.send, (self._number, None))

    def close(self) -> None:
        """End the process, even during a check."""
        self._process.end()


class OutdatedError(Exception):
    """A newer request arrived during the check of a project."""


class JudgingQuestions:
    """The server's numbered requests; a request without an analysis only makes earlier requests outdated."""

    def __init__(self, pipe: AnswerPipe) -> None:
        self._pipe = pipe
        self._newest = 0
        self._waiting: SimpleQueue[tuple[int, Analysis]] = SimpleQueue()

    def answer(self) -> None:
        """Answer requests until the server ends or closes the pipe, which ends this process immediately."""
        WatchedThread("questions", self._read).start()
        while True:
            self._pipe.answer(partial(self._judged, *self._waiting.get()))

    def _read(self) -> None:
        try:
            while True:
                number, analysis = self._pipe.receive()
                self._newest = max(self._newest, number)
                if analysis is not None:
                    self._waiting.put((number, analysis))
        except EOFError:
            os._exit(0)
        except BaseException:  # end after an internal error, because the server waits for an answer
            traceback.print_exc()
            os._exit(1)

    def _judged(self, number: int, analysis: Analysis) -> Judgement | None:
        def between() -> None:
            if self._newest != number:
                raise OutdatedError

        try:
            between()
            return analysis.judged(between)
        except OutdatedError:
            return None


def main() -> None:
    """Answer a server's requests until it ends."""
    with answering() as pipe:
        JudgingQuestions(pipe).answer()


if __name__ == "__main__":
    main()
