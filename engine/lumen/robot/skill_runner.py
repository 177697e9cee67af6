"""Verbs of features: their performers run in threads that no tick, and no stop, waits for."""

import json
import logging
from collections.abc import Mapping
from threading import Condition
from typing import Any, TypeVar

from lumen.errors import RobotError, RobotFailedError, RobotRefusedError
from lumen.feature import VerbRow, resolve
from lumen.language.added_verbs import whole_result
from lumen.language.commands import Do
from lumen.language.sections import section_of
from lumen.ports import SkillPerformer
from lumen.project.schema import faults
from lumen.robot.command_table import added_verb
from lumen.upkeep.threads import WatchedThread

Settings = TypeVar("Settings")
_log = logging.getLogger(__name__)


class SkillRunner:
    """Begins performers; one that has not returned after it was cancelled is not begun again until it has."""

    def __init__(self) -> None:
        self._calls: list[RunningSkill] = []

    def begin(self, command: Do, now: float) -> "RunningSkill":
        """Begin a verb at `now` [s]. Raises RobotError if no feature has it, or if its last call does not end."""
        verb = added_verb(command)
        self._calls = [call for call in self._calls if call.thread.is_alive()]
        if any(call.skill == command.skill and call.cancelled for call in self._calls):
            raise RobotRefusedError(f"`{command.skill}` was cancelled and has not ended yet: try again later")
        call = RunningSkill(command, verb, now)
        self._calls.append(call)
        call.thread.start()
        return call

    def close(self) -> None:
        """Cancel all calls; they end by themselves."""
        for call in self._calls:
            call.end()


class RunningSkill:
    """A verb under way: an activity for the robot, a `SkillCall` for the performer."""

    def __init__(self, command: Do, verb: VerbRow, now: float) -> None:
        self.skill, self.arguments = command.skill, command.arguments
        self.cancelled = False
        self.result: Mapping[str, Any] = {}
        self.thread = WatchedThread(f"lumen-skill-{command.skill}", self._run)
        self._verb, self._sections, self._now = verb, command.sections, now
        self._left = self._over = False
        self._failure = ""
        self._changed = Condition()

    def advance(self, now: float) -> bool:
        """Let the performer live until `now` [s]; return True once it has ended or was cancelled."""
        with self._changed:
            self._now = now
            self._changed.notify_all()
            if self._left:
                return True
            if failure := self._failure or self.thread.lost:
                raise RobotFailedError(failure)
            return self._over

    def cancel(self) -> None:
        """Have the robot wait for it no more, and the performer end early if its row does not forbid that."""
        self._left = True
        if self._verb.cancel:
            self.end()

    def end(self) -> None:
        """Let the performer end early."""
        with self._changed:
            self.cancelled = True
            self._changed.notify_all()

    def section(self, kind: type[Settings]) -> Settings:
        return section_of(self._sections, kind)

    def wait(self, seconds: float) -> bool:
        with self._changed:
            until = self._now + seconds
            self._changed.wait_for(lambda: self.cancelled or self._now >= until)
            return not self.cancelled

    def _run(self) -> None:
        try:
            performer: SkillPerformer = resolve(self._verb.performer)
            result, failure = self._checked(performer.perform(self)), ""
        except RobotError as error:
            result, failure = {}, str(error)
        except BaseException as error:  # whatever it is, it must not begin again
            _log.exception("the performer of `%s` failed", self.skill)
            result, failure = {}, f"`{self.skill}` failed: {error!r}"
        with self._changed:
            self.result, self._failure, self._over = result, failure, True

    def _checked(self, returned: Any) -> Mapping[str, Any]:
        """Return a result as the journal keeps it. Raises RobotFailedError if it does not fit the schema of the row."""
        try:
            result = {} if returned is None else json.loads(json.dumps(returned, allow_nan=False))
        except (TypeError, ValueError) as error:
            raise RobotFailedError(f"`{self.skill}` returned something that is not JSON data: {error}") from error
        if not isinstance(result, dict):
            raise RobotFailedError(f"`{self.skill}` returned {result!r}: return an object with names and values")
        for fault in faults(result, self._verb.result):
            raise RobotFailedError(f"`{self.skill}` returned something wrong: {fault.message}")
        return whole_result(self._verb, result)
