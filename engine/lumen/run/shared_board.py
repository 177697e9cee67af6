"""The shared values of a house's robots: a robot publishes its own, and receives those of the others."""

import logging
from collections import deque
from collections.abc import Callable, Mapping
from math import inf
from time import time
from typing import Any

from lumen.errors import BusError
from lumen.expressions.json_schema import JsonSchema
from lumen.language.causes import Cause
from lumen.language.events import Event
from lumen.language.projects import Project
from lumen.language.routing_keys import SHARED_KEY, key_of_house
from lumen.language.shared import SHARED, SHARED_EVENT, SharedKey, SharedKeys
from lumen.ports import Bus, Message
from lumen.statechart import Snapshot

RETELL_PERIOD = 10.0
"""The time after which unchanged values are published again [s], because a broker keeps none."""
MAX_WAITING_TOLD = 1_000
"""The number of messages that may wait for a tick; one more drops the oldest."""

_log = logging.getLogger(__name__)


class SharedBoard:
    """A robot's connection to the shared values of its house.

    Received values wait for `drain`, which returns an event for those that differ from the behaviour's.
    """

    def __init__(self, bus: Bus) -> None:
        self._bus = bus
        self._project: Project | None = None
        self._undo: Callable[[], None] | None = None
        self._key = ""
        self._waiting: deque[tuple[Mapping[str, Any], Cause]] = deque(maxlen=MAX_WAITING_TOLD)
        self._told: dict[str, Any] | None = None
        self._next, self._asked = -inf, False

    def listen(self, project: Project) -> None:
        """Subscribe for this project; at the next tick the robot publishes its values and requests those of others."""
        self._project, self._told = project, None
        key = key_of_house(SHARED_KEY, project.house) if project.section(SharedKeys).by_name else ""
        if key != self._key:
            if self._undo:
                self._undo()
            self._key, self._undo = key, self._bus.subscribe(key, self._hear) if key else None

    @property
    def empty(self) -> bool:
        """Whether no message and no other robot's request waits."""
        return not self._waiting and not self._asked

    @property
    def due(self) -> float:
        """When the values are published again [s]; infinite without shared values."""
        return self._next if self._key else inf

    def drain(self, snapshot: Snapshot, now: float) -> list[Event]:
        """Return the received values that differ from the behaviour's, as events at `now` [s]."""
        events, known = list[Event](), dict(snapshot.context.get(SHARED, {}))
        while self._waiting:
            values, cause = self._waiting.popleft()
            if news := {key: value for key, value in values.items() if known.get(key) != value}:
                known |= news
                events.append(Event(SHARED_EVENT, news, now, cause=cause))
        return events

    def tell(self, snapshot: Snapshot, now: float) -> None:
        """Publish the robot's own values if they changed, if another robot requests them, or after RETELL_PERIOD."""
        project = self._project
        if project is None or not self._key:
            return
        values = snapshot.context.get(SHARED, {})
        own = {name: values[name] for name in _owned_by(project.robot, project)}
        first = self._told is None
        if own == self._told and not self._asked and now < self._next:
            return
        self._told, self._asked, self._next = own, False, now + RETELL_PERIOD
        if not own and not first:
            return
        try:
            body = {"from": project.robot, "values": own, "asks": first}
            self._bus.publish(self._key, body, ttl=RETELL_PERIOD)
        except BusError as error:
            _log.warning("the shared values of the house can't be sent: %s", error)

    def _hear(self, message: Message) -> None:
        """Queue the values of a message if the sender owns them and their types are right; log any other message."""
        project = self._project
        match message.body:
            case {"from": str(robot), "values": dict(values), "asks": bool(asks)} if project:
                pass
            case _:
                _log.warning("a message on %s is ignored: it has no values", message.key)
                return
        if robot == project.robot:
            return
        self._asked = self._asked or asks
        owned = _owned_by(robot, project)
        news = {name: value for name, value in values.items() if name in owned}
        if wrong := [name for name in values if name not in owned or not _fits(owned[name].type, values[name])]:
            _log.warning(
                "a message from %s is ignored: `%s` is not its own key, or the value has the wrong type",
                robot[:60],
                wrong[0][:60],
            )
            return
        if news:
            self._waiting.append((news, Cause("message", message.id, message.key, robot, time())))


def _fits(kind: str, value: object) -> bool:
    return JsonSchema({"type": kind}).fits(value)


def _owned_by(robot: str, project: Project) -> dict[str, SharedKey]:
    """Return the shared keys of one robot by name."""
    return {name: key for name, key in project.section(SharedKeys).by_name.items() if key.owner == robot}
