"""Commands that come over the bus: begun at the next tick, answered when they are over."""

import logging
import threading
import time
from collections import deque
from collections.abc import Callable
from dataclasses import replace
from itertools import count
from typing import NamedTuple

from lumen.errors import BusError, RobotError
from lumen.language.commands import Language, Rest, Say, Stop
from lumen.language.events import Event
from lumen.language.projects import Project
from lumen.ports import Aim, Bus, Joints, Message, Robot, RobotCommand, Sense
from lumen.robots.dialect import command_from, stops

KEY = "avatar.{robot}.command"
ROUTE = "command"
WAITING = 1_000
AT_ONCE = 100
ENDED = "the robot takes no more commands"

_log = logging.getLogger(__name__)


class _Arrival(NamedTuple):
    """A message, and when it came [s]."""

    message: Message
    at: float


class Orders:
    """Takes what modules send to the robot's command key, under the ids `m1`, `m2`, …

    Messages may come on any thread; the robot is touched by `begin` alone. `command finished` goes to `reply_to` when
    the robot has finished, another text, with the reason, when it has not: everybody gets an answer. As many wait for
    `begin` as their route keeps, as long as its time to live; only what rests or stops the robot is never one too many,
    nor too late. `clock` [s] tells how long they have waited.
    """

    def __init__(self, project: Project, robot: Robot, bus: Bus, clock: Callable[[], float] = time.monotonic) -> None:
        self._project, self._robot, self._bus, self._clock = project, robot, bus, clock
        self._came: deque[_Arrival] = deque()
        self._coming = threading.Lock()
        self._refused, self._closed = 0, False
        self._running: dict[str, Message] = {}
        self._numbers = count(1)
        self._language = ""
        self._key = command_key(project)
        self._undo = bus.subscribe(self._key, self._receive)

    def begin(self) -> None:
        """Start what has come; what can't be understood, or has waited too long, is answered at once."""
        for _ in range(len(self._came)):
            message, at = self._came.popleft()
            try:
                self._check_age(message, at)
                self._perform(message, command_from(message.body, self._project, self._angles))
            except RobotError as error:
                _log.warning("a command was refused: %s", error)
                self._reply(message, f"command failed: {error}")
        if self._refused:
            _log.warning("%d commands were refused: too many came at once", self._refused)
            self._refused = 0

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
        """Understand commands by another bundle from now on, and take them under its key.

        The new key is listened to before the old one is given up. Where the bus refuses the new one, that is logged,
        and the old one stays: the robot is never out of reach.
        """
        self._project = project
        key = command_key(project)
        if key == self._key:
            return
        try:
            undo = self._bus.subscribe(key, self._receive)
        except BusError as error:
            _log.warning("commands are still taken under `%s`: %s", self._key, error)
            return
        self._undo()
        self._key, self._undo = key, undo

    def close(self) -> None:
        """Take no more commands; who still waits for an answer gets one."""
        self._undo()
        with self._coming:
            self._closed = True
        while self._came:
            self._reply(self._came.popleft().message, f"command failed: {ENDED}")
        for message in self._running.values():
            self._reply(message, "command cancelled")
        self._running.clear()

    def _receive(self, message: Message) -> None:
        """On whichever thread the bus has."""
        with self._coming:
            refusal = ENDED if self._closed else self._full(message)
            if not refusal:
                self._came.append(_Arrival(message, self._clock()))
        if refusal:
            self._refused += 1
            self._reply(message, f"command failed: {refusal}")

    def _full(self, message: Message) -> str:
        """Why there is no room for this one; empty where there is."""
        route = self._project.routes.get(ROUTE)
        keep = route.keep if route and route.keep else WAITING
        waiting = len(self._came)
        if waiting >= WAITING or (waiting >= keep and not stops(message.body)):
            return f"{waiting} commands are waiting already"
        return ""

    def _check_age(self, message: Message, at: float) -> None:
        route = self._project.routes.get(ROUTE)
        if route and route.ttl and self._clock() - at > route.ttl and not stops(message.body):
            raise RobotError("it came too late")

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


def command_key(project: Project) -> str:
    """Under which key a project's robot takes commands."""
    route = project.routes.get(ROUTE)
    return route.key_for(project.robot) if route else KEY.replace("{robot}", project.robot)
