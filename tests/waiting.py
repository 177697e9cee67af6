"""Waiting for a condition, with a deadline: no test sleeps."""

import inspect
import threading
import time
from collections.abc import Callable
from contextlib import suppress
from typing import Any

HANG = 300.0
"""The bound of every wait [s]: what is waited for takes seconds, and only a hang reaches this on any machine."""
IDLE = 9.0
"""How many times as long as a look took nobody looks again,"""
LONGEST_PAUSE = 0.25
"""but no longer than this [s]."""


class Collector:
    """A handler that keeps what it is handed, and lets a test wait for it."""

    def __init__(self) -> None:
        self.messages: list[Any] = []
        self._changed = threading.Condition()

    def __call__(self, message: Any) -> None:
        with self._changed:
            self.messages.append(message)
            self._changed.notify_all()

    @property
    def bodies(self) -> list[Any]:
        return [message.body for message in self.messages]

    def wait(self, count: int, timeout: float = HANG) -> list[Any]:
        """The bodies, once there are `count` of them; fails after `timeout` [s]."""
        with self._changed:
            arrived = self._changed.wait_for(lambda: len(self.messages) >= count, timeout)
        assert arrived, f"{len(self.messages)} of {count} messages came within {timeout:g} s"
        return self.bodies


def until(condition: Callable[[], object], timeout: float = HANG, *, every: float = 0.01) -> None:
    """Return once the condition holds, which is looked at `every` so often [s]; fails after `timeout` [s].

    A look that takes long, as one through a browser does, is followed by a longer pause: who waits leaves the machine
    to what is waited for.
    """
    deadline = time.monotonic() + timeout
    pause = threading.Event()
    while True:
        began = time.monotonic()
        if condition():
            return
        now = time.monotonic()
        assert now < deadline, f"it did not happen within {timeout:g} s: {_code(condition)}"
        pause.wait(max(every, min(IDLE * (now - began), LONGEST_PAUSE)))


def _code(condition: Callable[[], object]) -> str:
    """The lines of code that a condition is, or its name."""
    with suppress(OSError, TypeError):
        return " ".join(inspect.getsource(condition).split())
    return getattr(condition, "__name__", str(condition))
