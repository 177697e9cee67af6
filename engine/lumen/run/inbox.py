"""The conversion of messages to events: messages from any thread wait, with their senders, for the next tick."""

import logging
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from time import time

from lumen.language.causes import PEOPLE, Cause, CauseKind
from lumen.language.events import Event
from lumen.language.projects import Project
from lumen.language.routing_keys import TOLD, key_of_robot
from lumen.language.shared import SHARED_EVENT
from lumen.ports import Bus, Message
from lumen.upkeep.drops import DropLog

MAX_WAITING_EVENTS = 10_000
"""The number of events that may wait; one more drops the oldest."""

_log = logging.getLogger(__name__)


class Inbox:
    """A bounded queue of the events on every route that raises one; if it is full, a new event drops the oldest."""

    def __init__(self, bus: Bus) -> None:
        self._bus = bus
        self._waiting: deque[tuple[str, object, Cause]] = deque(maxlen=MAX_WAITING_EVENTS)
        self._drops = DropLog(_log, "events")
        self._undo: dict[tuple[str, str], Callable[[], None]] = {}
        self._told: Callable[[], None] | None = None
        self._known, self._robots = set[str](), set[str]()

    def listen(self, project: Project) -> None:
        """Subscribe to the new routes of a project, then cancel the subscriptions to those that are gone."""
        wanted = {(route.key_for(project.robot), route.event) for route in project.routes.values() if route.event}
        for key, event in sorted(wanted - self._undo.keys()):
            self._undo[key, event] = self._bus.subscribe(key, self._receiver(event))
        for gone in sorted(self._undo.keys() - wanted):
            self._undo.pop(gone)()
        self.hear_robots(project)

    @property
    def empty(self) -> bool:
        """Whether no event waits."""
        return not self._waiting

    def __len__(self) -> int:
        return len(self._waiting)

    def hear_robots(self, project: Project) -> None:
        """Subscribe to events from the project's other robots if lumen.yaml has `robots:`, else unsubscribe."""
        self._known = {t.event for state in project.machine.states.values() for t in state.transitions if t.event} - {
            SHARED_EVENT
        }
        self._robots = set(project.robots)
        key = key_of_robot(TOLD, project.robot)
        if project.told_apart and self._told is None:
            self._told = self._bus.subscribe(key, self._hear_robot)
        elif not project.told_apart and self._told is not None:
            self._told()
            self._told = None

    def _hear_robot(self, message: Message) -> None:
        """Queue an event from a robot of the house if the behaviour waits for exactly that name; log any other message.

        The exact name is required so that another robot can't fake an answer.
        """
        match message.body:
            case {"event": str(event), "data": data, "from": str(robot)} if (
                event in self._known and robot in self._robots
            ):
                cause = Cause("message", message.id, message.key, robot, time())
                self._push(event, data, cause)
            case _:
                _log.warning("a message on %s is ignored: it is not an event that this robot expects", message.key)

    def drain(self, now: float) -> list[Event]:
        """Remove and return all waiting events, dated `now` [s], each with its message as the cause."""
        events = []
        self._drops.tell()
        while self._waiting:
            name, body, cause = self._waiting.popleft()
            events.append(Event(name, body, now, cause=cause))
        return events

    def _receiver(self, event: str) -> Callable[[Message], None]:
        def receive(message: Message) -> None:
            kind: CauseKind = "person" if message.sender in PEOPLE else "message"
            cause = Cause(kind, message.id, message.key, message.sender, time())
            self._push(event, message.body, cause)

        return receive

    def _push(self, event: str, body: object, cause: Cause) -> None:
        self._drops.push(self._waiting, (event, body, cause), lambda waiting: waiting[0], "the behaviour can't keep up")


MAX_WAITING_MESSAGES = 1000
"""The number of messages that may wait; one more drops the oldest."""


class RouteInbox:
    """A queue of the newest `MAX_WAITING_MESSAGES` messages, with the names of their routes."""

    def __init__(self, bus: Bus) -> None:
        self._bus = bus
        self._waiting: deque[tuple[str, Message]] = deque(maxlen=MAX_WAITING_MESSAGES)
        self._undo: dict[tuple[str, str], Callable[[], None]] = {}

    def listen(self, project: Project, names: Iterable[str]) -> None:
        """Subscribe to the named routes that the project has, and cancel all other subscriptions."""
        routes = {name: route for name in names if (route := project.routes.get(name))}
        wanted = {(route.key_for(project.robot), name) for name, route in routes.items()}
        for key, name in sorted(wanted - self._undo.keys()):
            self._undo[key, name] = self._bus.subscribe(key, self._receiver(name))
        for gone in sorted(self._undo.keys() - wanted):
            self._undo.pop(gone)()

    def taken(self) -> Iterator[tuple[str, Message]]:
        """Remove and yield the messages, the oldest first."""
        while self._waiting:
            yield self._waiting.popleft()

    def _receiver(self, route: str) -> Callable[[Message], None]:
        return lambda message: self._waiting.append((route, message))
