"""Jobs that need much memory or time, each in a separate process: one at a time, with a short queue."""

import asyncio
import sys
from collections.abc import AsyncIterator, Iterable
from pathlib import Path
from typing import Any

import orjson

from lumen.errors import LumenError
from lumen.features.console.job_promises import JOB_TIME
from lumen.features.console.requests import DeniedError
from lumen.upkeep.judge_process import Fault, JudgeProcess, NoAnswerError

PROGRAM = "lumen.features.console.job"
MAX_WAITING = 8
"""The maximum number of running and waiting jobs; further ones are refused."""
MAX_ANSWER = 64 << 20
"""The largest answer of a job [bytes]."""


class Jobs:
    """Runs the jobs of `lumen.features.console.job` for the project in `root`; failures raise DeniedError."""

    def __init__(self, root: Path) -> None:
        self.root, self._turn = root, asyncio.Lock()
        self._waiting = 0

    async def do(self, job: str, *arguments: Any, told: AsyncIterator[bytes] | None = None) -> bytes:
        """Send the lines of `told` to a job, and return its answer. Errors that `told` raises are passed on."""
        if self._waiting >= MAX_WAITING:
            raise DeniedError(503, f"{MAX_WAITING} such requests are running already: try again in a moment")
        self._waiting += 1
        try:
            async with asyncio.timeout(JOB_TIME), self._turn:
                return await self._done(job, arguments, told)
        except TimeoutError:
            raise DeniedError(503, f"this takes longer than {JOB_TIME:g} s: use `lumen` in a terminal") from None
        finally:
            self._waiting -= 1

    def begin(self, job: str, *arguments: Any) -> JudgeProcess:
        """Start a process that does a job, and return it; the caller must end it."""
        line = [sys.executable, "-m", PROGRAM, job, str(self.root), orjson.dumps(arguments).decode()]
        process = JudgeProcess(line, MAX_ANSWER)
        try:
            process.start()
        except OSError as error:
            raise DeniedError(503, f"cannot start a process to compute this: {error.strerror}") from None
        return process

    async def _done(self, job: str, arguments: Iterable[Any], told: AsyncIterator[bytes] | None) -> bytes:
        process = self.begin(job, *arguments)
        try:
            if told is not None:
                async for line in told:
                    await asyncio.to_thread(process.send, line)
            return await _answer(process)
        finally:
            await asyncio.to_thread(process.end)


async def _answer(process: JudgeProcess) -> bytes:
    try:
        answer: bytes = await asyncio.to_thread(process.request, None)
    except (LumenError, NoAnswerError) as error:
        raise DeniedError(404 if isinstance(error, LumenError) else 503, why_none(error)) from None
    return answer


def why_none(error: LumenError | NoAnswerError) -> str:
    """Return the reason why a job has no answer, as a sentence."""
    if isinstance(error, LumenError):
        return str(error)
    if error.fault is Fault.SIZE:
        return f"the answer has more than {MAX_ANSWER >> 20} MB"
    if error.fault is Fault.MEMORY:
        return "this needs more memory than the console allows: use `lumen` in a terminal"
    how = f"ended by {error.signal}" if error.signal else f"exit code {error.code}"
    return f"the process that computes this ended without an answer ({how}): try again, or use `lumen` in a terminal"
