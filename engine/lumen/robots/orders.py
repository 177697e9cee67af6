"""Commands that come over the bus: begun at the next tick, answered when they are over."""

import logging
from collections import deque
from dataclasses import replace
from itertools import count

from lumen.errors import BusError, RobotError
from lumen.language.commands import Language, Rest, Say, Stop
from lumen.language.events import Event
from lumen.language.projects import Project
from lumen.ports import Aim, Bus, Joints, Message, Robot, RobotCommand, Sense
from lumen.robots.dialect import command_from

KEY = "avatar.{robot}.command"
ROUTE = "command"
WAITING = 1_000
AT_ONCE = 100

_log = logging.getLogger(__name__)


class Orders:
    """Takes what modules send to the robot's command key, under the ids `m1`, `m2`, …

    Messages may come on any thread; the robot is touched by `begin` alone. `command finished` goes to `reply_to` when
    the robot has finished, another text, with the reason, when it has not.
    """

    def __init__(self, project: Project, robot: Robot, bus: Bus) -> None:
        self._project, self._robot, self._bus = project, robot, bus
        self._came: deque[Message] = deque(maxlen=WAITING)
        self._running: dict[str, Message] = {}
        self._numbers = count(1)
        self._language = ""
        route = project.routes.get(ROUTE)
        key = route.key_for(project.robot) if route else KEY.replace("{robot}", project.robot)
        self._undo = bus.subscribe(key, self._came.append)

    def begin(self) -> None:
        """Start what has come; what can't be understood is answered at once."""
        while self._came:
            message = self._came.popleft()
            try:
                self._perform(message, command_from(message.body, self._project, self._angles))
            except RobotError as error:
                _log.warning("a command was refused: %s", error)
                self._reply(message, f"command failed: {error}")

    def answer(self, event: Event) -> bool:
        """Reply where this is the end of a command of ours; whether it is."""
        kind, _, id = event.name.partition(".command.")
        message = self._running.pop(id, None)
        if message is None:
            return False
        reason = event.data.get("reason", "") if isinstance(event.data, dict) else ""
        texts = {"done": "command finished", "cancelled": "command cancelled"}
        self._reply(message, texts.get(kind, f"command failed: {reason}"))
        return True

    def use(self, project: Project) -> None:
        """Understand commands by another bundle from now on."""
        self._project = project

    def close(self) -> None:
        """Take no more commands; who still waits for an answer gets one."""
        self._undo()
        for message in self._running.values():
            self._reply(message, "command cancelled")
        self._running.clear()

    def _perform(self, message: Message, command: RobotCommand | Language) -> None:
        if isinstance(command, Language):
            self._language = command.language
            self._reply(message, "command finished")
            return
        if isinstance(command, Say) and not command.language:
            command = replace(command, language=self._language)
        if len(self._running) >= AT_ONCE and not isinstance(command, Rest | Stop):
            raise RobotError(f"{AT_ONCE} commands are waiting already")
        id = f"m{next(self._numbers)}"
        if isinstance(command, Aim):
            self._robot.start(id, command)
            self._reply(message, "command finished")
        else:
            self._running[id] = message
            self._robot.start(id, command)

    def _angles(self) -> dict[str, float]:
        """Where the joints stand."""
        reading = self._robot.read(Sense.JOINT)
        return dict(zip(reading.names, reading.angles, strict=True)) if isinstance(reading, Joints) else {}

    def _reply(self, message: Message, text: str) -> None:
        try:
            self._bus.reply(message, text)
        except BusError as error:
            _log.warning("an answer to a command was not sent: %s", error)
