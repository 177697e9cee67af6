"""Performs skills: passes a call to a program, and the program's requests to the robot and the bus."""

import logging
from collections.abc import Callable, Mapping
from math import inf
from typing import Any

from lumen.errors import BusError, RobotFailedError
from lumen.features.skills.manifest import Skill
from lumen.features.skills.module_call import ModuleCall
from lumen.features.skills.process import GRACE, SkillProcess
from lumen.features.skills.workshop import Workshop, taker_of
from lumen.language.added_verbs import default_result
from lumen.language.causes import MessageOrigin
from lumen.language.commands import Do, Say
from lumen.language.routes import DEFAULT_COMMAND_TTL
from lumen.ports import SkillCall
from lumen.project.added_verbs import time_taken
from lumen.robot.command_codec import encode_command
from lumen.robot.robot_routes import COMMAND_ROUTE, publish_on
from lumen.run.sending import send

LOOK = 0.25
"""The time between two checks of the memory that a program uses [s]."""
MAX_TEXT = 1_000
"""The maximum length of a program's texts for speech and for the transcript [characters]."""
MAX_REQUESTS = 200
"""The maximum number of texts and messages that a program can send during a call."""

_log = logging.getLogger(__name__)


def perform(call: SkillCall) -> Mapping[str, Any]:
    """Perform a skill with its program; return the result, empty after a cancellation. Raises RobotError if it fails.

    Without a workshop no program runs: the call takes the skill's usual time and returns the default result. Outside of
    stories, a warning is logged.
    """
    workshop, skill = taker_of(call.skill, call.row), call.row.details
    if not isinstance(workshop, Workshop) or not isinstance(skill, Skill):
        if workshop is None:
            _log.warning("`%s` was only pretended: no exhibition of its project is open in this process", call.skill)
        call.wait(time_taken(Do(call.skill, call.arguments, row=call.row)))
        return default_result(call.row)
    try:
        with workshop.lent(call) as process:
            return _Performance(call, workshop, process).run()
    except RobotFailedError as error:
        workshop.failed(call.skill, str(error))
        raise


class _Performance:
    """A call that a process or a module performs."""

    def __init__(self, call: SkillCall, workshop: Workshop, process: SkillProcess | ModuleCall) -> None:
        self._call, self._workshop, self._process = call, workshop, process
        self._due, self._sent = inf, 0

    def run(self) -> Mapping[str, Any]:
        call, process = self._call, self._process
        process.begin(call.skill, call.arguments, call.wake)
        while not call.cancelled:
            call.wait_for(process.has_news, self._due - call.now, LOOK)
            for message in process.take():
                if (result := self._heard(message)) is not None:
                    self._workshop.worked(call.skill)
                    return result
            if call.now >= self._due:
                self._due = inf
                process.order(go=True)
            if fault := process.fault:
                raise RobotFailedError(self._killed(fault))
        self._end()
        return {}

    def _heard(self, message: Mapping[str, Any]) -> Mapping[str, Any] | None:
        """Process a message of the program; return the result, None if the call continues.

        Raises RobotFailedError if the program reports an error, returns no object, or has ended.
        """
        skill, tell = self._call.skill, self._workshop.tell
        match message:
            case {"result": dict() as result}:
                return result
            case {"result": other}:
                raise RobotFailedError(f"`{skill}` answered {other!r}: answer an object with names and values")
            case {"error": reason}:
                raise RobotFailedError(f"`{skill}` failed: {str(reason)[:MAX_TEXT]}")
            case {"ended": str(reason)}:
                self._workshop.crashed(skill)
                raise RobotFailedError(f"the program of `{skill}` is gone: {reason}")
            case {"wait": int() | float() as seconds} if seconds >= 0:
                self._due = self._call.now + seconds
            case {"progress": int() | float() as fraction, **more}:
                tell(skill, f"{fraction:.0%} {str(more.get('text', ''))[:MAX_TEXT]}".strip())
            case {"say": str(text), **more}:
                self._request(lambda: self._say(text, str(more.get("language", ""))))
            case {"publish": str(route), **more}:
                self._request(lambda: self._publish(route, more.get("body")))
            case _:
                tell(skill, f"a message of its program can't be used: {str(message)[:MAX_TEXT]}")
        return None

    def _request(self, request: Callable[[], str]) -> None:
        """Make a request to the bus, and report its error.

        Raises RobotFailedError if the call exceeds `MAX_REQUESTS`.
        """
        self._sent += 1
        if self._sent > MAX_REQUESTS:
            raise RobotFailedError(self._killed(f"it had more than {MAX_REQUESTS} texts and messages sent in one call"))
        if reason := request():
            self._workshop.report(self._call.skill, reason)

    def _say(self, text: str, language: str) -> str:
        project = self._workshop.project
        try:
            body = encode_command(Say(text[:MAX_TEXT], language or project.languages[0]))
            publish_on(self._workshop.bus, project, COMMAND_ROUTE, body, ttl=DEFAULT_COMMAND_TTL, origin=self._origin)
        except BusError as error:
            return str(error)
        return ""

    def _publish(self, route: str, body: Any) -> str:
        return send(self._workshop.bus, self._workshop.project, route, body, self._origin)

    @property
    def _origin(self) -> MessageOrigin:
        return MessageOrigin(sender=f"skill {self._call.skill}")

    def _end(self) -> None:
        """Have the program end a cancelled call; kill the program if the call does not end within `GRACE`."""
        try:
            self._process.order(cancel=True)
            ended = self._process.await_end(GRACE)
        except RobotFailedError:
            ended = False
        if not ended:
            self._killed(f"it did not end within {GRACE * 1_000:.0f} ms of its cancel")

    def _killed(self, reason: str) -> str:
        """Kill the program, or give up a module's call; return the message that reports it."""
        self._process.kill(reason)
        done = "was killed" if isinstance(self._process, SkillProcess) else "is given up"
        message = f"{self._process.title} {done}: {reason}"
        self._workshop.crashed(self._call.skill, message)
        self._workshop.report(self._call.skill, message)
        return message
