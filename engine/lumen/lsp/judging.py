"""A project judged in a process of its own: Python runs one thread at a time, and no answer waits for findings."""

import asyncio
import os
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from multiprocessing import connection, get_context, parent_process
from typing import Any

from lumen.lsp.analysis import Analysis, Judgement
from lumen.upkeep.threads import WatchedThread

_latest: Any = None
"""In the judging process: the number of the question that was asked last."""


class OutdatedError(Exception):
    """Something was written while the project was being judged."""


class Judge:
    """Judges one project at a time, and gives up on a text as soon as there is a newer one.

    The process is begun with the first question, and anew where a file has ended it.
    """

    def __init__(self) -> None:
        self._context = get_context("spawn")
        self._asked = self._context.Value("Q", 0, lock=False)
        self._pool: ProcessPoolExecutor | None = None

    async def judge(self, analysis: Analysis) -> Judgement | None:
        """What is to be said of a project; None where a newer question came, or its files end whoever reads them."""
        self._asked.value += 1
        if self._pool is None:
            self._pool = ProcessPoolExecutor(1, self._context, _begin, (self._asked,))
        pool = self._pool
        try:
            return await asyncio.wrap_future(pool.submit(_judge, analysis, self._asked.value))
        except OutdatedError:
            return None
        except BrokenProcessPool:
            if self._pool is pool:
                self._pool = None
            return None

    def outdated(self) -> None:
        """What is being judged is another by now."""
        self._asked.value += 1

    def close(self) -> None:
        """End the process; what it is at is not waited for."""
        self.outdated()
        if self._pool:
            self._pool.shutdown(wait=False, cancel_futures=True)


def _begin(latest: Any) -> None:
    """Prepare the judging process: it ends with the server, whose pipe to the editor it keeps out of."""
    global _latest
    _latest = latest
    os.dup2(2, 1)
    WatchedThread("server", _end_with_server).start()


def _end_with_server() -> None:
    if server := parent_process():
        connection.wait([server.sentinel])
    os._exit(0)


def _judge(analysis: Analysis, question: int) -> Judgement:
    def between() -> None:
        if _latest.value != question:
            raise OutdatedError

    between()
    return analysis.judged(between)
