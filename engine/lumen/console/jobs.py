"""What takes much memory or time, in a process that ends with it: one at a time, and few that wait for their turn."""

import asyncio
import signal
import sys
from asyncio.subprocess import PIPE, Process
from collections.abc import AsyncIterator, Iterable
from contextlib import suppress
from pathlib import Path
from typing import Any

import orjson

from lumen.console.job_promises import JOB_TIME, OUT_OF_MEMORY, REFUSED
from lumen.console.requests import DeniedError

PROGRAM = "lumen.console.job"
MAX_WAITING = 8
"""Jobs under way or waiting; one more is refused."""
MAX_ANSWER = 64 << 20
"""What a job may answer [bytes]."""


class Jobs:
    """Does jobs (`lumen.console.job` has them) for the project in `root`. Everything raises DeniedError."""

    def __init__(self, root: Path) -> None:
        self.root, self._turn = root, asyncio.Lock()
        self._waiting = 0

    async def do(self, job: str, *arguments: Any, told: AsyncIterator[bytes] | None = None) -> bytes:
        """What a job answers; it reads what it is `told`, line by line. What `told` raises is raised."""
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

    async def begin(self, job: str, *arguments: Any) -> Process:
        """A process that does a job, until it was `ended`."""
        line = [sys.executable, "-m", PROGRAM, job, str(self.root), orjson.dumps(arguments).decode()]
        try:
            return await asyncio.create_subprocess_exec(*line, stdin=PIPE, stdout=PIPE, limit=1 << 20)
        except OSError as error:
            raise DeniedError(503, f"cannot start a process to compute this: {error.strerror}") from None

    async def _done(self, job: str, arguments: Iterable[Any], told: AsyncIterator[bytes] | None) -> bytes:
        child = await self.begin(job, *arguments)
        telling = asyncio.ensure_future(_tell(child, told))
        answer = bytearray()
        try:
            assert child.stdout
            while part := await child.stdout.read(1 << 16):
                answer += part
                if len(answer) > MAX_ANSWER:
                    raise DeniedError(503, f"the answer has more than {MAX_ANSWER >> 20} MB")
            await telling
            if code := await child.wait():
                raise DeniedError(404 if code == REFUSED else 503, why_none(code, bytes(answer)))
            return bytes(answer)
        finally:
            telling.cancel()
            await ended(child)


async def _tell(child: Process, told: AsyncIterator[bytes] | None) -> None:
    assert child.stdin
    try:
        if told is not None:
            async for line in told:
                child.stdin.write(line + b"\n")
                await child.stdin.drain()
    except (BrokenPipeError, ConnectionResetError):
        return  # it has ended: its exit code says why
    finally:
        child.stdin.close()


async def ended(child: Process) -> None:
    """Return once it has, killed where it has not."""
    if child.returncode is None:
        with suppress(ProcessLookupError):
            child.kill()
        await child.wait()


def why_none(code: int, wrote: bytes) -> str:
    """Why a process with that exit code has no answer, as a sentence."""
    if code == REFUSED:
        return wrote.decode("utf-8", "replace")
    if code == OUT_OF_MEMORY:
        return "this needs more memory than the console allows: use `lumen` in a terminal"
    how = f"exit code {code}"
    if code < 0:
        with suppress(ValueError):
            how = f"ended by {signal.Signals(-code).name}"
    return f"the process that computes this ended without an answer ({how}): try again, or use `lumen` in a terminal"
