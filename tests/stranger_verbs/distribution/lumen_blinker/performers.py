"""Performers with manners of their own."""

from collections.abc import Callable, Mapping
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

    def __init__(self, act: Callable[[SkillCall], Mapping[str, Any] | None]) -> None:
        self._act = act

    def perform(self, call: SkillCall) -> Mapping[str, Any] | None:
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


WAITS, STALLS, BREAKS, REFUSES = Performer(_wait), Performer(_stall), Performer(_break), Performer(_refuse)
MISREPORTS = Performer(lambda call: {"blinked": "twice"})
