"""A skill's call that a module performs: a program on the bus, possibly on another machine."""

import threading
import time
import uuid
from collections import deque
from collections.abc import Callable, Mapping
from contextlib import suppress
from typing import Any

from lumen.errors import BusError, RobotFailedError
from lumen.language.projects import Project
from lumen.language.routes import DEFAULT_COMMAND_TTL
from lumen.language.routing_keys import SKILL_ANSWER, SKILL_CALL, key_of_robot
from lumen.ports import Bus, Message

ACCEPTING = 5.0
"""The time limit for a module's first answer to a call [s]."""
MAX_UNREAD_ANSWERS = 1_000


class ModuleAnswers:
    """Receives modules' answers to one robot's calls; it subscribes when the first call is added."""

    def __init__(self, project: Project, bus: Bus) -> None:
        self._key, self._bus = key_of_robot(SKILL_ANSWER, project.robot), bus
        self._open: dict[str, ModuleCall] = {}
        self._lock = threading.Lock()
        self._undo: Callable[[], None] | None = None

    def add(self, call: "ModuleCall") -> None:
        with self._lock:
            self._open[call.id] = call
            if self._undo is None:
                self._undo = self._bus.subscribe(self._key, self._take)

    def remove(self, call: "ModuleCall") -> None:
        with self._lock:
            self._open.pop(call.id, None)

    def close(self) -> None:
        with self._lock:
            undo, self._undo = self._undo, None
        if undo:
            undo()

    def _take(self, message: Message) -> None:
        body = message.body
        if isinstance(body, dict) and (call := self._open.get(str(body.get("call")))):
            call.answered(body)


class ModuleCall:
    """A call, sent to a module of the project's robot; it has the interface of a `SkillProcess`."""

    def __init__(self, project: Project, bus: Bus, module: str, answers: ModuleAnswers) -> None:
        self.id, self.ended = uuid.uuid4().hex[:12], ""
        self.title = f"the module `{module}`"
        self._key = key_of_robot(SKILL_CALL, project.robot).replace("{module}", module)
        self._bus, self._answers = bus, answers
        self._messages: deque[Mapping[str, Any]] = deque(maxlen=MAX_UNREAD_ANSWERS)
        self._changed = threading.Condition()
        self._wake: Callable[[], None] = lambda: None
        self._over = self._heard = False
        self._begun = time.monotonic()

    @property
    def alive(self) -> bool:
        return not self.ended

    @property
    def fault(self) -> str:
        """The reason to give up the call, if the module does not answer within ACCEPTING; else empty."""
        silent = not self._heard and time.monotonic() - self._begun > ACCEPTING
        return f"it did not answer within {ACCEPTING:g} s: is it running, on this bus?" if silent else ""

    def begin(self, skill: str, arguments: Mapping[str, Any], wake: Callable[[], None]) -> None:
        """Send the call. Raises RobotFailedError if the bus refuses it."""
        self._wake = wake
        self._answers.add(self)
        self.order(skill=skill, arguments=dict(arguments))

    def order(self, **message: Any) -> None:
        """Send a message about the call. Raises RobotFailedError if the bus refuses it."""
        try:
            self._bus.publish(self._key, {"call": self.id, **message}, ttl=DEFAULT_COMMAND_TTL)
        except BusError as error:
            raise RobotFailedError(f"{self.title} can't be reached: {error}") from None

    def answered(self, body: Mapping[str, Any]) -> None:
        """Receive an answer, on any thread; answers after the result or the error are ignored."""
        with self._changed:
            if self._over:
                return
            self._heard, self._over = True, "result" in body or "error" in body
            if "accepted" not in body:
                self._messages.append(body)
            self._changed.notify_all()
        self._wake()

    def has_news(self) -> bool:
        return bool(self._messages)

    def take(self) -> list[Mapping[str, Any]]:
        with self._changed:
            taken = list(self._messages)
            self._messages.clear()
        return taken

    def await_end(self, timeout: float) -> bool:
        with self._changed:
            return self._changed.wait_for(lambda: self._over, timeout)

    def kill(self, reason: str) -> None:
        """Cancel the call and give it up, because a program on another machine can't be killed."""
        self.ended = reason
        with suppress(RobotFailedError):
            self.order(cancel=True)

    def close(self) -> None:
        self._answers.remove(self)
