"""A behaviour in another process, observed through its trace on the bus."""

import logging
from collections import deque
from collections.abc import Callable, Mapping
from typing import Any, Protocol

from lumen.errors import BusError
from lumen.language.approvals import Autonomy
from lumen.language.command_data import from_trace
from lumen.language.commands import Command
from lumen.language.events import Event
from lumen.language.operator_requests import APPROVE, AUTONOMY, PRESS
from lumen.language.projects import Project
from lumen.language.routing_keys import OPERATOR_REQUEST, key_of_robot
from lumen.ports import Bus, Message
from lumen.run.trace_publisher import TRACE_ROUTE
from lumen.run.troubles import RunTrouble
from lumen.upkeep.threads import MessageGuard

REQUEST_TTL = 5.0
"""The longest time that a request may wait for the brain [s]."""
MAX_PENDING_TRACES = 10_000
"""The number of messages that may wait for a tick; one more drops the oldest."""

_log = logging.getLogger(__name__)


class TraceListener(Protocol):
    """An observer of a trace."""

    def see(
        self, states: frozenset[str], entered: tuple[str, ...], context: Mapping[str, Any], place: str = ""
    ) -> None:
        """Called when the states, those just entered, the context or the robot's place change."""
        ...

    def performing(self, command: Command, now: float) -> None:
        """Called for each command that the trace reports; the robot may have begun it already."""
        ...

    def answered(self, event: Event) -> None:
        """Called when the robot answered a command or noticed something."""
        ...

    def troubled(self, trouble: RunTrouble) -> None:
        """Called when a trouble occurs."""
        ...


class TraceSubscriber:
    """A subscriber to a behaviour's trace (`TracePublisher`), which calls `watchers` at each `tick`.

    It is the environment of a story; `happen` raises an event of the robot.
    """

    def __init__(self, project: Project, bus: Bus, happen: Callable[[Event], None]) -> None:
        self.project, self.bus, self.happen = project, bus, happen
        self.watchers: list[TraceListener] = []
        self._received: deque[Message] = deque(maxlen=MAX_PENDING_TRACES)
        self._guard = MessageGuard(_log, "a listener of the behaviour's trace")
        self._undo = bus.subscribe(project.key_of(TRACE_ROUTE), self._received.append)

    def tick(self, now: float) -> None:
        """Pass all received messages on to the watchers."""
        while self._received:
            message = self._received.popleft()
            body = message.body
            if isinstance(body, dict) and body.get("robot") == self.project.robot:
                with self._guard(message.key):
                    for watcher in self.watchers:
                        _tell(watcher, body, now)

    def press(self, label: str, by: str) -> str:
        """Request a button press from the brain; return why the request can't be sent, else an empty string.

        The result is not reported here.
        """
        return self._wish(PRESS(button=label, by=by))

    def approve(self, by: str, *, go: bool) -> str:
        """Request a decision on the event that has waited longest.

        Return why the request can't be sent, else an empty string.
        """
        return self._wish(APPROVE(id="", go=go, by=by))

    def set_autonomy(self, level: Autonomy, by: str) -> None:
        """Request that marked transitions wait for GO, or not; a failure to send the request is ignored."""
        self._wish(AUTONOMY(level=level, by=by))

    def _wish(self, request: dict[str, Any]) -> str:
        try:
            self.bus.publish(key_of_robot(OPERATOR_REQUEST, self.project.robot), request, ttl=REQUEST_TTL)
        except BusError as error:
            return str(error)
        return ""

    def close(self) -> None:
        """Unsubscribe."""
        self._undo()


def _tell(watcher: TraceListener, body: dict[str, Any], now: float) -> None:
    match body:
        case {"states": list(states), "context": dict(context)}:
            entered, place = tuple(map(str, body.get("entered", ()))), str(body.get("place", ""))
            watcher.see(frozenset(map(str, states)), entered, context, place)
        case {"command": dict(said)} if (command := from_trace(said)) is not None:
            watcher.performing(command, now)
        case {"answer": {"id": str(id), "kind": str(kind)} as answer}:
            reason = {"reason": str(answer["reason"])} if "reason" in answer else None
            watcher.answered(Event(f"{kind}.command.{id}", reason, now))
        case {"trouble": {"kind": "fall" | "dropped" | "do" | "joint" as kind, "what": str(what)}}:
            watcher.troubled(RunTrouble(kind, what))
        case {"noticed": str(name)}:
            watcher.answered(Event(name, None, now))
