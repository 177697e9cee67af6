"""The hall around a robot in another process."""

import logging
from collections.abc import Callable
from dataclasses import asdict
from typing import Any

from lumen.errors import BusError, UsageError
from lumen.language.diagnostics import did_you_mean
from lumen.language.events import Event
from lumen.language.projects import Project
from lumen.language.stories import Visitor
from lumen.ports import Bus, Message
from lumen.robot.robot_routes import HALL_ROUTE, SEEN_ROUTE, publish_on

HALL_MESSAGE_TTL = 2.0
"""The time to live on the bus of a visitor's action [s]."""

_log = logging.getLogger(__name__)


class RemoteHall:
    """Sends a visitor's actions to the process that simulates the hall, and receives how the robot sees the visitor."""

    def __init__(self, project: Project, bus: Bus) -> None:
        self._project, self._bus = project, bus
        self._face: tuple[float, float] | None = None
        self._key = project.key_of(SEEN_ROUTE)
        self._undo: Callable[[], None] = bus.subscribe(self._key, self._see)

    def use(self, project: Project) -> None:
        """Switch to the routes of this project."""
        self._project, key = project, project.key_of(SEEN_ROUTE)
        if key != self._key:
            undo, self._key = self._undo, key
            self._undo = self._bus.subscribe(key, self._see)
            undo()

    def place(self, visitor: Visitor | None) -> None:
        self._do({"visitor": None if visitor is None else asdict(visitor)})

    def face(self) -> tuple[float, float] | None:
        return self._face

    def touch(self, sensor: str, pressed: bool) -> None:
        """Press or release a tactile sensor. Raises UsageError for one that the robot does not have."""
        known = self._project.body.tactile
        if sensor not in known:
            raise UsageError(f"no sensor `{sensor}`: {did_you_mean(sensor, known, 'there are')}")
        self._do({"sensor": sensor, "pressed": pressed})

    def sound(self) -> None:
        self._do({"sound": True})

    def plug(self, plugged: bool) -> None:
        self._do({"plugged": plugged})

    def happen(self, event: Event) -> None:
        """Make the robot notice an event of a story."""
        self._do({"event": event.name, "data": event.data})

    def close(self) -> None:
        self._undo()

    def _do(self, body: dict[str, Any]) -> None:
        try:
            publish_on(self._bus, self._project, HALL_ROUTE, body, ttl=HALL_MESSAGE_TTL)
        except BusError as error:
            _log.warning("an action of the visitor was not sent: %s", error)

    def _see(self, message: Message) -> None:
        place = message.body.get("face") if isinstance(message.body, dict) else None
        right = isinstance(place, list) and len(place) == 2 and all(isinstance(x, int | float) for x in place)
        self._face = (float(place[0]), float(place[1])) if right and place else None
