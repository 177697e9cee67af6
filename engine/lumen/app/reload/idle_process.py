"""A judging process that nobody needs just now, kept a little while for who needs one next.

A start has its files read in a process of its own, and what takes saved files needs one as well: it takes over that
one, which has everything imported and knows the files. So does the next start in the same program.
"""

import atexit
import subprocess
import threading
from typing import NamedTuple

from lumen.app.reload.delta import DeltaDecoder

LINGER = 10.0
"""How long it is kept [s]."""


class JudgingProcess(NamedTuple):
    """The process, how it was begun, and what unpacks the projects that it sends."""

    child: "subprocess.Popen[bytes]"
    command: tuple[str, ...]
    receiver: DeltaDecoder

    @property
    def lives(self) -> bool:
        return self.child.poll() is None

    def end(self) -> None:
        self.child.kill()
        self.child.communicate()


_turn = threading.Lock()
_idle: list[tuple[JudgingProcess, threading.Timer]] = []
"""The one that is kept, and what will end it; empty where there is none."""


def keep(process: JudgingProcess) -> None:
    """Keep a process that waits for questions, in place of the one that was kept."""
    end_idle()
    timer = threading.Timer(LINGER, _end, [process])
    timer.daemon = True
    with _turn:
        _idle.append((process, timer))
    timer.start()


def take(command: tuple[str, ...]) -> JudgingProcess | None:
    """The process that was kept, if it lives and was begun so; whoever takes it ends it or has it kept again."""
    with _turn:
        if not _idle or _idle[0][0].command != command:
            return None
        process, timer = _idle.pop()
    timer.cancel()
    if not process.lives:
        process.end()
        return None
    return process


@atexit.register
def end_idle() -> None:
    """End the process that was kept."""
    with _turn:
        found = [*_idle]
        _idle.clear()
    for process, timer in found:
        timer.cancel()
        process.end()


def _end(process: JudgingProcess) -> None:
    with _turn:
        mine = bool(_idle) and _idle[0][0] is process
        if mine:
            _idle.clear()
    if mine:
        process.end()
