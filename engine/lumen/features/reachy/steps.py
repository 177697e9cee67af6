"""An activity of Reachy Mini as steps that never block: each step yields a call, or waits for the next tick."""

from collections.abc import Callable, Generator
from typing import Any

from lumen.errors import RobotError
from lumen.features.reachy.daemon_api import DaemonCall

Steps = Generator[DaemonCall | None, Any, None]
"""Steps that yield a call and receive its result, or yield `None` and receive the time of the next tick [s]."""


class StepActivity:
    """An executor's activity made of steps; a cancellation ends it immediately and calls `stop`.

    `missed` describes a goal that is not reached although the activity succeeds; else it is empty.
    """

    def __init__(self, steps: Steps, stop: Callable[[], None] = lambda: None) -> None:
        self._steps, self._stop = steps, stop
        self._call: DaemonCall | None = None
        self._begun = self._cancelled = False
        self.missed = ""

    def advance(self, now: float) -> bool:
        if self._cancelled:
            return True
        try:
            self._call = self._steps.send(now) if self._begun and self._call is None else self._next()
            while self._call is not None and self._call.done:
                self._call = self._answered(self._call)
        except StopIteration:
            return True
        return False

    def cancel(self) -> None:
        if not self._cancelled:
            self._cancelled = True
            self._steps.close()
            self._stop()

    def _next(self) -> DaemonCall | None:
        """Return the call in progress, at first that of the first step; None if the steps wait for the next tick."""
        if self._begun:
            return self._call
        self._begun = True
        return next(self._steps)

    def _answered(self, call: DaemonCall) -> DaemonCall | None:
        try:
            answer = call.result()
        except RobotError as error:
            return self._steps.throw(error)
        return self._steps.send(answer)
