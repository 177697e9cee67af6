"""Verbs of features: their performers run in threads that no tick, and no stop, waits for."""

import json
import logging
from collections.abc import Callable, Mapping
from math import inf
from queue import SimpleQueue
from threading import TIMEOUT_MAX, Condition
from typing import Any, TypeVar

from lumen.errors import RobotError, RobotFailedError, RobotRefusedError
from lumen.feature import VerbRow, resolve
from lumen.language.added_verbs import whole_result
from lumen.language.commands import Do
from lumen.language.sections import section_of
from lumen.ports import SkillPerformer
from lumen.project.added_verbs import time_taken
from lumen.project.broken_features import shown
from lumen.project.schema import faults
from lumen.robot.command_checks import added_verb, check_arguments
from lumen.upkeep.threads import WatchedThread

Settings = TypeVar("Settings")
LOCKSTEP_PATIENCE = 30.0
"""The time that a performer may compute while the robot's time stands still [s]."""

_log = logging.getLogger(__name__)


class SkillRunner:
    """Begins the performers of verbs; one that was cancelled is not begun again until it has returned.

    With `lockstep` the robot's time stands still while a performer computes, as a story with real code needs: an
    `advance` returns only when each performer waits for a time that has not come, or has ended.
    """

    def __init__(self, *, lockstep: bool = False) -> None:
        self._calls: list[RunningSkill] = []
        self._lockstep = lockstep
        self._ends: dict[str, Mapping[str, Any] | str] = {}
        self._begun: SimpleQueue[RunningSkill | None] = SimpleQueue()
        self._starter = WatchedThread("lumen-skills", self._start)

    def set_ends(self, ends: Mapping[str, Mapping[str, Any] | str]) -> None:
        """Set how verbs end from now on, without running their code: with a result, or by `fails` or `hangs`."""
        self._ends |= ends

    def begin(self, command: Do, now: float) -> "RunningSkill | PretendedSkill":
        """Begin a verb at `now` [s].

        Raises RobotError if the verb is unknown, a cancelled call of it has not ended, or it is set to fail.
        """
        verb = added_verb(command)
        if (end := self._ends.get(command.skill)) is not None:
            return PretendedSkill(command, verb, end, now)
        self._calls = [call for call in self._calls if not call.over]
        if any(call.skill == command.skill and call.cancelled for call in self._calls):
            raise RobotRefusedError(f"`{command.skill}` was cancelled and has not ended yet: try again later")
        call = RunningSkill(command, verb, now, lockstep=self._lockstep)
        self._calls.append(call)
        if not self._starter.started:
            self._starter.start()
        self._begun.put(call)
        return call

    def close(self) -> None:
        """Cancel all calls, without waiting for their ends."""
        for call in self._calls:
            call.end()
        self._begun.put(None)

    def _start(self) -> None:
        """Start the thread of each call: ten in one tick would be too slow."""
        while (call := self._begun.get()) is not None:
            call.thread.start()


class PretendedSkill:
    """A verb whose end a story sets: an activity that runs no code. Raises RobotFailedError for `fails`."""

    def __init__(self, command: Do, verb: VerbRow, end: Mapping[str, Any] | str, now: float) -> None:
        if end == "fails":
            raise RobotFailedError(f"{command.skill} fails in this story")
        self.result = whole_result(verb, {} if isinstance(end, str) else end)
        self._until = inf if end == "hangs" else now + time_taken(command)

    def advance(self, now: float) -> bool:
        return now >= self._until

    def cancel(self) -> None:
        self._until = 0.0


class RunningSkill:
    """A verb under way: an activity for the robot, a `SkillCall` for the performer."""

    def __init__(self, command: Do, verb: VerbRow, now: float, *, lockstep: bool = False) -> None:
        self._command = command
        self.skill, self.arguments, self.row = command.skill, command.arguments, verb
        self.cancelled = False
        self.result: Mapping[str, Any] = {}
        self.thread = WatchedThread(f"lumen-skill-{command.skill}", self._run)
        self._sections, self._now, self._lockstep = command.sections, now, lockstep
        self._until: float | None = None
        self._left = self._over = self._entered = False
        self._failure = ""
        self._changed = Condition()

    def advance(self, now: float) -> bool:
        """Run the performer until `now` [s]; return True once it has ended or was cancelled.

        Raises RobotFailedError if it failed.
        """
        with self._changed:
            self._now = now
            if self._until is not None and now >= self._until:
                self._changed.notify_all()
            if self._lockstep and not self._changed.wait_for(self._settled, LOCKSTEP_PATIENCE):
                self._left = self.cancelled = True
                self._changed.notify_all()
                limit = f"{LOCKSTEP_PATIENCE:g} s"
                raise RobotFailedError(f"`{self.skill}` computed for {limit} without an answer or a `wait`")
            if self._left:
                return True
            if failure := self._failure or self.thread.lost:
                raise RobotFailedError(failure)
            return self._over

    def cancel(self) -> None:
        """End the robot's wait for the verb, and end the performer early unless the verb's row forbids that."""
        self._left = True
        if self.row.cancel:
            self.end()

    @property
    def over(self) -> bool:
        """True if the performer has ended, or will not begin: it was cancelled before, or has no thread."""
        return self._over or bool(self.thread.lost) or (self.cancelled and not self._entered)

    def end(self) -> None:
        """Make the performer end early."""
        with self._changed:
            self.cancelled = True
            self._changed.notify_all()

    @property
    def now(self) -> float:
        return self._now

    def section(self, kind: type[Settings]) -> Settings:
        return section_of(self._sections, kind)

    def wait(self, seconds: float) -> bool:
        self.wait_for(lambda: False, seconds)
        return not self.cancelled

    def wait_for(self, ready: Callable[[], bool], seconds: float = inf, within: float = inf) -> bool:
        with self._changed:
            self._until = until = self._now + seconds
            if self._lockstep:
                self._changed.notify_all()
            real = min(within, TIMEOUT_MAX)
            self._changed.wait_for(lambda: self.cancelled or self._now >= until or ready(), real)
            self._until = None
            return ready()

    def wake(self) -> None:
        with self._changed:
            self._changed.notify_all()

    def _settled(self) -> bool:
        """Return True if the performer has ended, waits for a later time, or is no longer awaited."""
        waits = self._until is not None and self._now < self._until < inf
        return waits or self._over or self._left or bool(self.thread.lost)

    def _run(self) -> None:
        with self._changed:
            if self.cancelled:
                return
            self._entered = True
        try:
            check_arguments(self._command)
            performer: SkillPerformer = resolve(self.row.performer)
            result, failure = self._checked(performer.perform(self)), ""
        except RobotError as error:
            result, failure = {}, str(error)
        except BaseException as error:  # the watched thread would begin the verb again
            _log.exception("the performer of `%s` failed", self.skill)
            result, failure = {}, f"`{self.skill}` failed: {shown(error)}"
        with self._changed:
            self.result, self._failure, self._over = result, failure, True
            self._changed.notify_all()

    def _checked(self, returned: Any) -> Mapping[str, Any]:
        """Return a result as JSON data, completed by the defaults of the row.

        Raises RobotFailedError if it is not JSON data that fits the schema of the row.
        """
        try:
            result = {} if returned is None else json.loads(json.dumps(returned, allow_nan=False))
        except (TypeError, ValueError) as error:
            raise RobotFailedError(f"`{self.skill}` returned something that is not JSON data: {error}") from error
        if not isinstance(result, dict):
            raise RobotFailedError(f"`{self.skill}` returned {result!r}: return an object with names and values")
        for fault in faults(result, self.row.result):
            raise RobotFailedError(f"`{self.skill}` returned something wrong: {fault.message}")
        return whole_result(self.row, result)
