"""A command as a sequence of calls: each step yields a call and continues when NAOqi has answered."""

from collections.abc import Callable, Generator, Sequence
from dataclasses import dataclass
from math import inf
from typing import Any

from lumen.errors import RobotError, RobotFailedError
from lumen.features.naoqi.session import NaoqiCall

CANCEL_TIMEOUT = 1.5
"""The time limit for the end of a cancelled command [s]; a walk first completes its current step."""

ABORT_RETRY_PERIOD = 0.25
"""The time between two aborts [s], because NAOqi may have received the first abort before the command."""


@dataclass(frozen=True)
class WhileWaiting:
    """Waits for a call, and calls `each` with the time [s] at every tick until the call has ended."""

    call: NaoqiCall
    each: Callable[[float], None]


Awaited = NaoqiCall | WhileWaiting | None
CallSteps = Generator[Awaited, Any, Any]
"""Steps that yield a call and receive its result; `None` waits for the next tick and receives its time [s]."""


class CallSequence:
    """An activity of the executor in steps that wait for calls.

    `abort` returns the calls that make NAOqi end the command; `recover` returns the steps after an abort. If NAOqi does
    not end a cancelled command within `patience` [s], the command fails.
    """

    def __init__(
        self,
        steps: CallSteps,
        abort: Callable[[], Sequence[NaoqiCall]] = lambda: (),
        recover: Callable[[], CallSteps] | None = None,
        patience: float = CANCEL_TIMEOUT,
    ) -> None:
        self._steps, self._abort, self._recover, self._patience = steps, abort, recover, patience
        self._wait: Awaited = None
        self._begun = self._cancelled = False
        self._aborting: list[NaoqiCall] = []
        self._until = self._again = inf

    def advance(self, now: float) -> bool:
        """Run all possible steps at `now` [s]; return True at the end. Raises RobotError if a call or abort failed."""
        if self._cancelled:
            if not self._quiet(now):
                return False
            self._steps.close()
            if self._recover is None:
                return True
            self._steps, self._recover, self._cancelled, self._wait = self._recover(), None, False, None
            self._begun, self._abort = False, lambda: ()
        return self._go(now)

    def cancel(self) -> None:
        """Abort the command; `advance` then waits until the command ends."""
        if not self._cancelled:
            self._cancelled = True
            self._aborting = list(self._abort())

    def _quiet(self, now: float) -> bool:
        """Return whether NAOqi has ended the cancelled command; if not, repeat the abort.

        Raises RobotFailedError after `patience`.
        """
        if self._until == inf:
            self._until, self._again = now + self._patience, now + ABORT_RETRY_PERIOD
        call = self._wait.call if isinstance(self._wait, WhileWaiting) else self._wait
        if (call is None or call.done) and all(c.done for c in self._aborting):
            return True
        if now >= self._until:
            raise RobotFailedError(f"it was cancelled but did not end within {self._patience:g} s")
        if now >= self._again:
            self._again = now + ABORT_RETRY_PERIOD
            self._aborting = [c for c in self._aborting if not c.done] or list(self._abort())
        return False

    def _go(self, now: float) -> bool:
        """Run all possible steps at `now` [s]; return True after the last step."""
        try:
            if not self._begun:
                self._begun, self._wait = True, next(self._steps)
            elif self._wait is None:
                self._wait = self._steps.send(now)
            while self._wait is not None:
                call = self._wait.call if isinstance(self._wait, WhileWaiting) else self._wait
                if isinstance(self._wait, WhileWaiting):
                    self._wait.each(now)
                if not call.done:
                    return False
                self._wait = self._answer(call)
        except StopIteration:
            return True
        return False

    def _answer(self, call: NaoqiCall) -> Awaited:
        try:
            value = call.result()
        except RobotError as error:
            return self._steps.throw(error)
        return self._steps.send(value)
