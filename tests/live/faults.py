"""Faults at steps of our own code: the functions that are entered are listed, and any of them can be made to fail."""

import sys
from collections.abc import Callable
from pathlib import Path
from types import CodeType, FrameType
from typing import TypeVar

import lumen

ROOT = str(Path(lumen.__file__).parent)
T = TypeVar("T")


class FaultError(Exception):
    """A fault of ours."""


def steps(work: Callable[[], object], above: Callable[..., object]) -> list[CodeType]:
    """Return the functions of Lumen that `work` enters within a call of `above`, in that order."""
    found: dict[CodeType, None] = {}

    def enter(frame: FrameType) -> None:
        if frame.f_code.co_filename.startswith(ROOT) and frame.f_code is not above.__code__ and _within(frame, above):
            found[frame.f_code] = None

    _traced(work, enter)
    return list(found)


def failing(step: CodeType, work: Callable[[], T], above: Callable[..., object]) -> T:
    """Return the result of `work`; this step raises FaultError once, at its first entry within a call of `above`."""
    failed = []

    def enter(frame: FrameType) -> None:
        if frame.f_code is step and not failed and _within(frame, above):
            failed.append(step)
            raise FaultError(name(step))

    made = _traced(work, enter)
    assert failed, f"{name(step)} was not entered"
    return made


def name(step: CodeType) -> str:
    """Return the name of a step, such as `insight/migration/moving.py:exits`."""
    return f"{step.co_filename.removeprefix(ROOT)[1:]}:{step.co_qualname}"


def _traced(work: Callable[[], T], enter: Callable[[FrameType], None]) -> T:
    def trace(frame: FrameType, event: str, argument: object) -> None:
        enter(frame)

    before = sys.gettrace()
    sys.settrace(trace)
    try:
        return work()
    finally:
        sys.settrace(before)


def _within(frame: FrameType | None, above: Callable[..., object]) -> bool:
    while frame is not None:
        if frame.f_code is above.__code__:
            return True
        frame = frame.f_back
    return False
