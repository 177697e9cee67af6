"""An idle process for checking files, kept for a while for the next user.

A start checks its files in a separate process, and the reloader needs one as well: it reuses the same process, which
has imported everything and knows the files. So does the next start in the same program.
"""

import atexit
import threading
from typing import NamedTuple

from lumen.run.reload.delta import DeltaDecoder
from lumen.upkeep.judge_process import JudgeProcess

LINGER = 10.0
"""The time for which the process is kept [s]."""


class IdleProcess(NamedTuple):
    """A process, and the decoder of the projects that it sends."""

    process: JudgeProcess
    receiver: DeltaDecoder


_turn = threading.Lock()
_idle: list[tuple[IdleProcess, threading.Timer]] = []
"""At most one kept process, with the timer that will end it."""


def keep(idle: IdleProcess) -> None:
    """Keep a process that waits for questions, and end the one that was kept."""
    end_idle()
    timer = threading.Timer(LINGER, _end, [idle])
    timer.daemon = True
    with _turn:
        _idle.append((idle, timer))
    timer.start()


def take(command: tuple[str, ...]) -> IdleProcess | None:
    """Return the kept process if it is alive and runs this command, else None; the caller must end or keep it."""
    with _turn:
        if not _idle or _idle[0][0].process.command != command:
            return None
        idle, timer = _idle.pop()
    timer.cancel()
    if not idle.process.alive:
        idle.process.end()
        return None
    return idle


@atexit.register
def end_idle() -> None:
    """End the kept process."""
    with _turn:
        found = [*_idle]
        _idle.clear()
    for idle, timer in found:
        timer.cancel()
        idle.process.end()


def _end(idle: IdleProcess) -> None:
    with _turn:
        mine = bool(_idle) and _idle[0][0] is idle
        if mine:
            _idle.clear()
    if mine:
        idle.process.end()
