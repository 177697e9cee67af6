"""Performers with manners of their own."""

from collections.abc import Callable
from threading import Event
from typing import Any

from lumen.errors import RobotFailedError
from lumen.ports import SkillCall

STALLED = Event()
"""Set to end stalled performers, which ignore a cancel."""
CALLS: list[SkillCall] = []
"""The calls so far."""


class Performer:
    """Performs by a function."""

    def __init__(self, act: Callable[[SkillCall], Any]) -> None:
        self._act = act

    def perform(self, call: SkillCall) -> Any:
        CALLS.append(call)
        return self._act(call)


def _wait(call: SkillCall) -> None:
    call.wait(1e9)


def _stall(call: SkillCall) -> None:
    STALLED.wait()


def _break(call: SkillCall) -> None:
    raise ZeroDivisionError("by zero")


def _refuse(call: SkillCall) -> None:
    raise RobotFailedError("the eyelids stick")


def _exit(call: SkillCall) -> None:
    raise SystemExit(3)


WAITS, STALLS, BREAKS, REFUSES = Performer(_wait), Performer(_stall), Performer(_break), Performer(_refuse)
EXITS, COUNTS, SPOILS = Performer(_exit), Performer(lambda call: 3), Performer(lambda call: {"eyes": {1, 2}})
MISREPORTS = Performer(lambda call: {"blinked": "twice"})
