"""Commands that arrive on the bus: they begin at the next tick, and are reported on until they are over."""

import logging
import threading
import time
from collections import deque
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from itertools import count
from math import isfinite
from typing import Any, NamedTuple

from lumen.errors import BusError, RobotError, RobotRefusedError
from lumen.language.commands import Language, Rest, Say, Stop, Wake
from lumen.language.events import MISSED, RESULT, Event
from lumen.language.motions import MotionDefinition
from lumen.language.projects import Project
from lumen.ports import Aim, Bus, Joints, Live, Message, Perform, Robot, RobotCommand, Sense
from lumen.robot.command_codec import decode_command, method_of, own_id, stops, stops_all
from lumen.robot.command_queries import CommandQueries
from lumen.robot.command_reports import CANCELLED, FAILED, FINISHED, CommandRecord, CommandReports
from lumen.robot.command_table import parts_of, row_of
from lumen.robot.deduplication_log import DeduplicationLog
from lumen.robot.executor import FOREIGN
from lumen.robot.person_hold import HoldListener, PersonHold
from lumen.robot.robot_routes import (
    AIM_ROUTE,
    COMMAND_ROUTE,
    REPORT_ROUTE,
    STOP_ROUTE,
    publish_on,
)
from lumen.upkeep.drops import DropLog, ReasonLog
from lumen.upkeep.threads import MessageGuard

MAX_WAITING_COMMANDS = 1_000
"""The number of commands of other modules that may wait."""
MAX_WAITING_OWN = 1_000
"""The number of commands of the behaviour that may wait in addition."""
MAX_WAITING_AIMS = 100
MAX_AIM_AGE = 0.5
"""The greatest age of an aim [s]: a newer one exists by then."""
MAX_RUNNING_COMMANDS = 100
MAX_REMEMBERED_MOTIONS = 20
"""The number of latest motions whose analysis is cached."""
MAX_BACKLOG = 15.0
"""The longest expected wait for earlier commands [s]; a command that would wait longer is refused."""
MAX_SPEECH = 60.0
"""The longest estimated duration of a text [s]."""
ENDED = "the robot accepts no more commands"
ID_TAKEN = "its sender has used that id for another command: give each command its own id"
STOPPED_AGAIN = "the robot was stopped again right after that: resume it again if it may move"
RESTARTED = "the robot has restarted since it began that command"

OWN = "b"
"""The prefix of the ids of commands from a brain in another process."""

_log = logging.getLogger(__name__)


class _Arrival(NamedTuple):
    """A message, and when it arrived [s]."""

    message: Message
    at: float


class CommandListener(HoldListener):
    """A listener to the commands on the bus; each method may be left out."""

    def given(self, command: RobotCommand, id: str) -> None:
        """Called when the robot begins a command."""

    def refused(self, method: str, reason: str) -> None:
        """Called when the robot does not begin a command; `method` is empty if it could not be read."""

    def urgent(self) -> None:
        """Called on any thread when a message that stops the robot arrives: `begin` should be called soon."""

    def is_brains(self, id: str) -> bool:
        """Return whether a command of this id is one of the behaviour's."""
        return False


class CommandReceiver:
    """Receives the commands that modules send to the robot's keys, as `m1`, `m2`, …, and those of a brain, as `b1`, ….

    Messages may arrive on any thread; only `begin` uses the robot. Each sender gets an answer from `CommandReports`.
    Commands that stop the robot begin before all that arrived with them; those that arrived before a stop of everything
    do not begin at all. At most as many commands wait for `begin` as their route keeps, and for at most the route's
    time to live; those of the behaviour are counted separately. Commands that stop the robot are exempt from both
    limits.

    A command with an `id` is performed once, however often its sender sends it; another command with that id is
    refused. Commands that stop the robot are performed each time that they are sent, with any id; only a message that
    the bus delivers a second time is ignored.

    `clock` [s] measures the time that commands have waited. Commands that move the robot are refused while a person
    keeps it still (`hold`).
    """

    def __init__(
        self,
        project: Project,
        robot: Robot,
        bus: Bus,
        clock: Callable[[], float] = time.monotonic,
        listeners: Sequence[CommandListener] = (),
    ) -> None:
        self._project, self._robot, self._bus, self._clock = project, robot, bus, clock
        self._listeners = listeners
        self.hold = PersonHold(*listeners)
        self._received: deque[_Arrival] = deque()
        self._own_waiting = self._others_waiting = 0
        self._aims: deque[_Arrival] = deque(maxlen=MAX_WAITING_AIMS)
        self._coming = threading.Lock()
        self._closed = False
        self.guard = MessageGuard(_log, "the robot's server")
        self.drops = DropLog(_log, "commands")
        self._unfit = ReasonLog(_log, "a command was refused: %(reason)s", self.drops, clock)
        self._reports = CommandReports(self._tell, self._reply)
        self._queries = CommandQueries(robot, self._reports, self.hold, self._reply, self.resume)
        self._numbers, self._own_numbers = count(1), count(1)
        self._language = ""
        self._log_of_begun = DeduplicationLog()
        self._motions: deque[MotionDefinition] = deque(maxlen=MAX_REMEMBERED_MOTIONS)
        self._undo: dict[str, tuple[str, Callable[[], None]]] = {}
        for route in (COMMAND_ROUTE, STOP_ROUTE, AIM_ROUTE):
            self._undo[route] = self._listen(route)

    def recall(self, begun_before: DeduplicationLog) -> None:
        """Record commands that begin from now on; those that the previous process began count as failed.

        Commands to rest or to stop are not recorded, because they may be performed twice.
        """
        self._log_of_begun = begun_before
        for begun in begun_before.before:
            record = CommandRecord(Message("", None), begun.id, state=FAILED, reason=RESTARTED)
            self._reports.remember(record, begun.sender)

    @property
    def waiting(self) -> bool:
        """Whether commands have arrived that have not begun."""
        return bool(self._received or self._aims)

    def begin(self) -> None:
        """Start the commands that have arrived, and report what the robot has begun.

        Commands that are malformed, or have waited too long, are answered at once.
        """
        for arrival in self._taken(self._aims):
            with self.guard(arrival.message.key):
                self._aim(arrival)
        came = self._taken_commands()
        last = max((i for i, arrival in enumerate(came) if stops_all(arrival.message.body)), default=-1)
        before, after = came[: last + 1], came[last + 1 :]
        for arrival in [a for a in before if stops(a.message.body)]:
            self._guarded(arrival)
        for arrival in [a for a in before if not stops(a.message.body)]:
            self._guarded(arrival, overtaken=True)
        for arrival in after:
            self._guarded(arrival)
        for id in self._robot.begun():
            self._reports.begun(id)
        self.drops.tell()
        self.guard.drops.tell()

    def answer(self, event: Event) -> bool:
        """Report the end of a command from the bus; return whether the event is such an end."""
        kind, _, id = event.name.partition(".command.")
        data = event.data if isinstance(event.data, dict) else {}
        reason = data.get("reason") or data.get(MISSED, "")
        return self._reports.answered(kind, id, str(reason), data.get(RESULT))

    def use(self, project: Project) -> None:
        """Decode commands by another bundle from now on, and receive them under its keys.

        A new key is subscribed before the old one is given up. If the bus refuses the new one, that is logged and
        the old one stays, so the robot is always reachable.
        """
        self._project = project
        for route, (key, undo) in list(self._undo.items()):
            if project.key_of(route) == key:
                continue
            try:
                self._undo[route] = self._listen(route)
            except BusError as error:
                _log.warning("commands are still accepted on the old key `%s`: %s", key, error)
                continue
            undo()

    def resume(self, by: str) -> None:
        """Let a robot move that a person stopped; it stands up if the behaviour has no transition for `resume`."""
        self.hold.release(by)
        machine = self._project.machine
        if not any(t.event == "resume" for state in machine.states.values() for t in state.transitions):
            self._robot.start(self._number(), Wake())

    def close(self) -> None:
        """Accept no more commands, and answer those that are still open."""
        for _, undo in self._undo.values():
            undo()
        with self._coming:
            self._closed = True
        for arrival in self._taken_commands():
            self._refuse(arrival.message, ENDED)
        self._reports.end()
        self.drops.tell(all=True)

    def _listen(self, route: str) -> tuple[str, Callable[[], None]]:
        key = self._project.key_of(route)
        return key, self._bus.subscribe(key, self._receive_aim if route == AIM_ROUTE else self._receive)

    def _receive(self, message: Message) -> None:
        """Queue a message for `begin`, or refuse it; called on a thread of the bus."""
        stopping, own = stops(message.body), self._is_brains(own_id(message.body))
        with self._coming:
            refusal = ENDED if self._closed else "" if stopping else self._full(own=own)
            if not refusal:
                self._received.append(_Arrival(message, self._clock()))
                self._own_waiting += own and not stopping
                self._others_waiting += not own and not stopping
        if refusal:
            self.drops.add(message.key, refusal)
            self._refuse(message, refusal)
        elif stopping:
            for listener in self._listeners:
                listener.urgent()

    def _receive_aim(self, message: Message) -> None:
        self._aims.append(_Arrival(message, self._clock()))

    @staticmethod
    def _taken(waiting: deque[_Arrival]) -> list[_Arrival]:
        return [waiting.popleft() for _ in range(len(waiting))]

    def _taken_commands(self) -> list[_Arrival]:
        with self._coming:
            self._own_waiting = self._others_waiting = 0
            return self._taken(self._received)

    def _full(self, *, own: bool) -> str:
        """Return why no further command, of the behaviour (`own`) or of other modules, may wait; empty if it may."""
        if own:
            waiting, most = self._own_waiting, MAX_WAITING_OWN
        else:
            route = self._project.routes.get(COMMAND_ROUTE)
            waiting, most = self._others_waiting, MAX_WAITING_COMMANDS
            most = min(most, route.keep if route and route.keep else most)
        return f"{waiting} commands are waiting already" if waiting >= most else ""

    def _refuse(self, message: Message, reason: str) -> None:
        """Report that a command failed before it was examined; its sender may send it again."""
        record = CommandRecord(message, own_id(message.body), method_of(message.body), state=FAILED, reason=reason)
        self._reply(message, record.report() if record.id else record.text())

    def _guarded(self, arrival: _Arrival, *, overtaken: bool = False) -> None:
        """Handle a message; an error in Lumen's code loses only this command."""
        with self.guard(arrival.message.key):
            self._take(arrival, overtaken=overtaken)

    def _take(self, arrival: _Arrival, *, overtaken: bool = False) -> None:
        """Perform a message's command, or report why not.

        The command is `overtaken` if a stop of everything came after it.
        """
        message = arrival.message
        record = CommandRecord(message, own_id(message.body), method_of(message.body), body=message.body)
        stopping = stops(message.body)
        if overtaken and record.method == "resume":
            self._refuse(message, STOPPED_AGAIN)
            return
        if record.method in CommandQueries.METHODS:
            self._queries.answer(message)
            return
        if known := self._reports.find(record.id, message.sender):
            performed = _delivered_again(known.asker, message) if stopping else known.body in (None, message.body)
            if performed:
                self._reports.repeat(known, message)
                return
            if not stopping:
                self.drops.add(message.key, ID_TAKEN)
                self._refuse(message, ID_TAKEN)
                return
        self._reports.remember(record, message.sender)
        try:
            self._check_age(arrival)
            if overtaken:
                self._reports.change(record, CANCELLED)
            else:
                self._perform(record, decode_command(message.body, self._project, self._angles))
        except RobotError as error:
            self._warn(message.key, record.method, str(error))
            self._reports.change(record, FAILED, str(error))
        except Exception:
            self._reports.change(record, FAILED, "the robot's server failed on this command")
            raise

    def _warn(self, key: str, method: str, reason: str) -> None:
        if self._unfit(key, reason):
            for listener in self._listeners:
                listener.refused(method, reason)

    def _check_age(self, arrival: _Arrival) -> None:
        route = self._project.routes.get(COMMAND_ROUTE)
        if route and route.ttl and self._clock() - arrival.at > route.ttl and not stops(arrival.message.body):
            raise RobotRefusedError("it came too late")

    def _perform(self, record: CommandRecord, command: RobotCommand | Language) -> None:
        if isinstance(command, Language):
            self._language = command.language
            self._reports.change(record, FINISHED)
            return
        own = self._is_brains(record.id)
        if reason := self.hold.admit(command, behavior=own):
            raise RobotRefusedError(reason)
        if isinstance(command, Perform):
            command = Perform(self._remembered(command.motion))
        if isinstance(command, Rest) and command.by:
            self.hold.stop(command.by)
        if isinstance(command, Say) and not command.language:
            command = replace(command, language=self._language)
        if self._reports.running >= MAX_RUNNING_COMMANDS and not own and not isinstance(command, Rest | Stop):
            raise RobotRefusedError(f"{MAX_RUNNING_COMMANDS} commands are waiting already")
        if record.id and not isinstance(command, Rest | Stop):
            self._log_of_begun.note(record.id, record.asker.sender)
        if isinstance(command, Aim | Live):
            self._robot.start(self._number(), command)
            self._reports.change(record, FINISHED)
            return
        if record.asker.body.get("replace") is True:
            self._clear(command)
        elif not isinstance(command, Rest | Stop) and not own:
            self._check_backlog(record, command)
        record.at = f"{OWN}{next(self._own_numbers)}" if own else self._number()
        self._reports.accept(record)
        self._robot.start(record.at, command)
        for listener in self._listeners:
            listener.given(command, record.id)

    def _remembered(self, motion: MotionDefinition) -> MotionDefinition:
        """Return an equal motion that was received before; otherwise remember this one and return it.

        A brain in another process sends the whole motion with each play.
        """
        for known in self._motions:
            if known == motion:
                return known
        self._motions.append(motion)
        return motion

    def _check_backlog(self, record: CommandRecord, command: RobotCommand) -> None:
        """Raise RobotRefusedError for a text that is too long, or a command that would wait too long."""
        takes = row_of(command).duration(command)
        record.parts, record.takes = parts_of(command, self._project.body), takes if isfinite(takes) else 0.0
        if isinstance(command, Say) and takes > MAX_SPEECH:
            raise RobotRefusedError(f"this text takes {takes:.0f} s to say: send one of at most {MAX_SPEECH:g} s")
        if (ahead := self._reports.ahead(record.parts)) > MAX_BACKLOG:
            raise RobotRefusedError(f"earlier commands still take {ahead:.0f} s: send this one later, or `stop` them")

    def _clear(self, command: RobotCommand) -> None:
        """Stop the speech or the motion under way, because this command replaces it."""
        if isinstance(command, Say):
            self._robot.start(self._number(), Stop("say"))
        elif isinstance(command, Perform):
            self._robot.start(self._number(), Stop("play"))

    def _aim(self, arrival: _Arrival) -> None:
        """Perform an aim unless it is too old. Aims arrive as a stream, so they get no answer."""
        if self._clock() - arrival.at > MAX_AIM_AGE:
            return
        try:
            command = decode_command(arrival.message.body, self._project, self._angles)
        except RobotError as error:
            _log.debug("an aim was refused: %s", error)
            return
        if isinstance(command, Aim) and not self.hold.admit(command, behavior=False):
            self._robot.start("", command)

    def _is_brains(self, id: str) -> bool:
        return any(listener.is_brains(id) for listener in self._listeners)

    def _number(self) -> str:
        return f"{FOREIGN}{next(self._numbers)}"

    def _angles(self) -> dict[str, float]:
        """Return the present angles of the joints [rad]; empty if the robot does not sense them."""
        reading = self._robot.read(Sense.JOINT)
        return dict(zip(reading.names, reading.angles, strict=True)) if isinstance(reading, Joints) else {}

    def _tell(self, report: dict[str, Any]) -> None:
        self._safely(partial(publish_on, self._bus, self._project, REPORT_ROUTE, report))

    def _reply(self, message: Message, body: Any) -> None:
        self._safely(partial(self._bus.reply, message, body))

    def _safely(self, send: Callable[[], None]) -> None:
        try:
            send()
        except BusError as error:
            _log.warning("an answer to a command was not sent: %s", error)


def _delivered_again(known: Message, message: Message) -> bool:
    """Return True if this is the known message delivered a second time; without an id, it counts as a new one."""
    return bool(message.id) and (known.id, known.time, known.body) == (message.id, message.time, message.body)
