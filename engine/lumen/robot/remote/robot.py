"""A robot in another process, which the runtime uses over the bus like any other."""

import logging
import time
import uuid
from collections import deque
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

from lumen.errors import BadCommandError, BusError, LumenError, Refused
from lumen.feature import table
from lumen.language.causes import MessageOrigin
from lumen.language.commands import Rest, Stop
from lumen.language.events import CUE, MISSED, RESULT, Event, robot_events
from lumen.language.projects import Project
from lumen.ports import Aim, Bus, Live, Message, NumericReading, OtherReading, Perform, Reading, RobotCommand, Sense
from lumen.robot.command_bounds import CommandBounds
from lumen.robot.command_codec import encode_command
from lumen.robot.command_reports import ACCEPTED, CANCELLED, FAILED, FINISHED, STARTED, UNKNOWN_COMMAND
from lumen.robot.robot_routes import (
    AIM_ROUTE,
    COMMAND_ROUTE,
    NOTICED_ROUTE,
    REPORT_ROUTE,
    STOP_ROUTE,
    publish_on,
)
from lumen.robot.sense_codec import decode_reading

RESEND_PERIOD = 1.0
"""An unanswered command is sent again after this long [s].

The robot still performs it only once, unless it is a stop, which is safe to perform twice.
"""
COMMAND_ANSWER_TIMEOUT = 5.0
"""A command without any answer fails after this long [s], and is cancelled if the robot accepts it later."""
OUTCOME_QUERY_PERIOD = 5.0
"""The outcome of a command is queried this long after its last report [s]."""
AIM_TTL = 0.2
COMMAND_TTL = 2.0
MAX_PENDING_REPORTS = 10_000

_ENDS = {FINISHED: "done", FAILED: "error", CANCELLED: "cancelled", UNKNOWN_COMMAND: "lost"}
_FORGOTTEN = "the robot has restarted and forgotten the command"

_log = logging.getLogger(__name__)


@dataclass
class _Pending:
    """A command that is not over; times are in [s] on the clock `patience`."""

    id: str
    """The id under which the brain started the command."""
    command: RobotCommand | None
    """The command; None if another process of this session sent it."""
    since: float
    """When the command was first sent."""
    queried: float
    """When the command was last sent, queried or reported on."""
    heard: bool = False
    """Whether the robot has reported on the command."""
    cancelled: bool = False
    """Whether the brain has cancelled the command."""
    held: bool = False
    """Whether the command waits until the robot has received another command that stops the robot."""


Delegate = Callable[[str, Perform], bool]
"""A function that passes a motion on to another module under an id; it returns False if no module performs it."""


class RemoteRobot:
    """The robot whose server is on this bus, as the routes of the project say.

    The ids of its commands begin with `session`, which no other process has and by which the robot recognises its
    brain. A command without an answer is sent again; after 5 s it fails, and is cancelled if the robot accepts it
    later. Commands that stop the robot have a route of their own: commands sent before and not answered are cancelled,
    and later ones wait until the robot has the stop. `clock` returns the time of events [s], `patience` the time by
    which answers are awaited [s]. `delegate` may pass motions on to another module.
    """

    def __init__(
        self,
        project: Project,
        bus: Bus,
        clock: Callable[[], float],
        *,
        patience: Callable[[], float] = time.monotonic,
        delegate: Delegate = lambda id, command: False,
        session: str = "",
    ) -> None:
        self.session = session or uuid.uuid4().hex[:12]
        self._project, self._bus, self._clock, self._patience = project, bus, clock, patience
        self._delegate, self._bounds = delegate, CommandBounds(project.body)
        self._pending: dict[str, _Pending] = {}
        self._forsaken: deque[str] = deque(maxlen=1_000)
        self._received: deque[Message] = deque(maxlen=MAX_PENDING_REPORTS)
        self._events: list[Event] = []
        self._begun: list[str] = []
        self._readings: dict[str, tuple[OtherReading, float]] = {}
        self._undo: dict[str, Callable[[], None]] = {}
        self.use(project)

    def use(self, project: Project) -> None:
        """Switch to the routes of this project; new keys are subscribed before old ones are given up."""
        self._project = project
        wanted = {
            project.key_of(REPORT_ROUTE): self._received.append,
            project.key_of(NOTICED_ROUTE): self._received.append,
        }
        for sense, row in table("senses").items():
            if sense in project.routes and row.decode:
                wanted[project.routes[sense].key_for(project.robot)] = partial(self._sense, sense)
        for key in sorted(wanted.keys() - self._undo.keys()):
            self._undo[key] = self._bus.subscribe(key, wanted[key])
        for key in sorted(self._undo.keys() - wanted.keys()):
            self._undo.pop(key)()

    def start(self, id: str, command: RobotCommand) -> None:
        if isinstance(command, Aim):
            if aim := self._bounds.aim(command):
                self._send(AIM_ROUTE, encode_command(aim), AIM_TTL)
            return
        try:
            command = self._bounds.fit(command)
        except BadCommandError as error:
            self._events.append(Event(f"error.command.{id}", {"reason": str(error)}, self._clock()))
            return
        if isinstance(command, Live):
            self._send(COMMAND_ROUTE, encode_command(command), COMMAND_TTL)
            return
        now = self._patience()
        whole = f"{self.session}.{id}"
        pending = _Pending(id, command, now, now, held=self._stopping())
        if isinstance(command, Rest | Stop):
            self._call_off()
            pending.held = False
        self._pending[whole] = pending
        if not pending.held:
            self._order(whole, command)

    def forward(self, whole: str, command: RobotCommand) -> None:
        """Have the robot perform another module's command, under the full id that it has there."""
        self._order(whole, command, delegable=False)

    def cancel(self, id: str) -> None:
        for whole, pending in list(self._pending.items()):
            if pending.id == id and pending.held:
                self._end(whole, "cancelled")
            elif pending.id == id:
                pending.cancelled, pending.queried = True, self._patience()
                self._request("cancel", whole)

    def recover(self, session: str, ids: Iterable[str]) -> None:
        """Query the outcomes of commands that an earlier process of a session began; they are answered as usual."""
        now = self._patience()
        for id in ids:
            self._pending[f"{session}.{id}"] = _Pending(id, None, now, now)
            self._request("outcome", f"{session}.{id}")

    def lose(self, reason: str) -> None:
        """End all open commands as lost, because the robot is gone."""
        for whole in list(self._pending):
            self._end(whole, "lost", reason)

    def poll(self) -> Sequence[Event]:
        while self._received:
            self._hear(self._received.popleft())
        self._chase()
        self._release()
        events, self._events = self._events, []
        return events

    def begun(self) -> Sequence[str]:
        begun, self._begun = self._begun, []
        return begun

    def read(self, sense: Sense) -> Reading | None:
        """Return the newest reading that has arrived; None for images, which are for other modules."""
        found = self._readings.get(sense)
        return found[0] if found and isinstance(found[0], NumericReading) else None

    def read_other(self, sense: str) -> OtherReading | None:
        found = self._readings.get(sense)
        return found[0] if found else None

    def time(self) -> float | None:
        """Return the robot's time [s], from the newest reading and its age; None before the first reading."""
        newest = max(self._readings.values(), key=lambda found: found[1], default=None)
        return None if newest is None else newest[0].time + self._clock() - newest[1]

    def close(self) -> None:
        """End the subscriptions; the robot continues with the commands that were sent."""
        for undo in self._undo.values():
            undo()
        self._undo.clear()

    def _order(self, whole: str, command: RobotCommand, *, delegable: bool = True) -> None:
        if delegable and isinstance(command, Perform) and self._delegate(whole, command):
            return
        way = STOP_ROUTE if isinstance(command, Rest | Stop) else COMMAND_ROUTE
        self._send(way, {**encode_command(command), "id": whole}, COMMAND_TTL, whole)

    def _stopping(self) -> bool:
        """Return True while a command that stops the robot is on its way."""
        return any(isinstance(p.command, Rest | Stop) and not p.heard for p in self._pending.values())

    def _call_off(self) -> None:
        """Cancel commands that are still on their way: they must not be performed after one that stops the robot."""
        for whole, pending in list(self._pending.items()):
            if pending.held:
                self._end(whole, "cancelled")
            elif not pending.heard and not isinstance(pending.command, Rest | Stop):
                pending.cancelled = True
                self._request("cancel", whole)

    def _release(self) -> None:
        """Send the commands that were held back, unless one that stops the robot is still on its way."""
        if self._stopping():
            return
        now = self._patience()
        for whole, pending in list(self._pending.items()):
            if pending.held and pending.command is not None:
                pending.held, pending.since, pending.queried = False, now, now
                self._order(whole, pending.command)

    def _request(self, method: str, whole: str) -> None:
        self._send(COMMAND_ROUTE, {"type": "motion", "method": method, "parameter": {"id": whole}}, COMMAND_TTL)

    def _send(self, way: str, body: dict[str, Any], ttl: float, cause: str = "") -> None:
        try:
            publish_on(self._bus, self._project, way, body, ttl=ttl, origin=MessageOrigin(cause=cause))
        except BusError as error:
            _log.warning("a command was not sent to the robot: %s", error)

    def _sense(self, sense: str, message: Message) -> None:
        """Store a reading of a sense; called on a thread of the bus."""
        try:
            reading = decode_reading(sense, message.body, tuple(self._project.body.joints))
        except LumenError as error:
            raise Refused(str(error)) from error
        if reading:
            self._readings[sense] = (reading, self._clock())

    def _hear(self, message: Message) -> None:
        match message.body:
            case {"id": str(whole), "state": str(state)}:
                self._report(whole, state, str(message.body.get("reason", "")), message.body.get("result"))
            case {"name": str(name)} if name in (*robot_events(), CUE) and message.key == self._project.key_of(
                NOTICED_ROUTE
            ):
                self._events.append(Event(name, message.body.get("data"), self._clock()))

    def _report(self, whole: str, state: str, reason: str, result: Any = None) -> None:
        pending = self._pending.get(whole)
        if pending is None:
            if whole in self._forsaken and state in (ACCEPTED, STARTED):
                self._request("cancel", whole)
            return
        pending.queried = self._patience()
        if state == STARTED:
            self._begun.append(pending.id)
        pending.heard = True
        if state in _ENDS:
            self._end(whole, _ENDS[state], reason or (_FORGOTTEN if state == UNKNOWN_COMMAND else ""), result)

    def _end(self, whole: str, kind: str, reason: str = "", result: Any = None) -> None:
        pending = self._pending.pop(whole)
        data: dict[str, Any] | None = {"reason": reason} if kind in ("error", "lost") else None
        if kind == "done" and reason:
            data = {MISSED: reason}
        elif kind == "done" and isinstance(result, dict):
            data = {RESULT: result}
        self._events.append(Event(f"{kind}.command.{pending.id}", data, self._clock()))

    def _chase(self) -> None:
        """Resend commands without an answer, query those without recent news, and fail those that stay unanswered."""
        now = self._patience()
        for whole, pending in list(self._pending.items()):
            quiet = now - pending.queried
            if pending.held:
                continue
            if not pending.heard and now - pending.since > COMMAND_ANSWER_TIMEOUT:
                self._forsaken.append(whole)
                self._end(whole, "error", "the robot does not answer")
            elif quiet > (OUTCOME_QUERY_PERIOD if pending.heard and not pending.cancelled else RESEND_PERIOD):
                pending.queried = now
                if pending.cancelled:
                    self._request("cancel", whole)
                elif pending.heard or pending.command is None:
                    self._request("outcome", whole)
                else:
                    self._order(whole, pending.command, delegable=False)
