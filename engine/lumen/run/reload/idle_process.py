"""A judging process that nobody needs just now, kept a little while for who needs one next.

A start has its files read in a process of its own, and what takes saved files needs one as well: it takes over that
one, which has everything imported and knows the files. So does the next start in the same program.
"""

import atexit
import threading
from typing import NamedTuple

from lumen.run.reload.delta import DeltaDecoder
from lumen.upkeep.judge_process import JudgeProcess

LINGER = 10.0
"""How long it is kept [s]."""


class IdleProcess(NamedTuple):
    """A process, and what unpacks the projects that it sends."""

    process: JudgeProcess
    receiver: DeltaDecoder


_turn = threading.Lock()
_idle: list[tuple[IdleProcess, threading.Timer]] = []
"""The one that is kept, and what will end it; empty where there is none."""


def keep(idle: IdleProcess) -> None:
    """Keep a process that waits for questions, in place of the one that was kept."""
    end_idle()
    timer = threading.Timer(LINGER, _end, [idle])
    timer.daemon = True
    with _turn:
        _idle.append((idle, timer))
    timer.start()


def take(command: tuple[str, ...]) -> IdleProcess | None:
    """Return the process that was kept, if it runs this command; its new owner ends it or has it kept again."""
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
    """End the process that was kept."""
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
