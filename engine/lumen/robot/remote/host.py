"""A robot's body on the bus: it publishes senses, receives commands, and serves the simulated hall around it."""

import logging
from collections import deque
from collections.abc import Callable, Mapping, Sequence
from dataclasses import fields
from typing import Any

from lumen.errors import BusError, LumenError
from lumen.language.events import Event, robot_events
from lumen.language.numbers import is_finite_number
from lumen.language.projects import Project
from lumen.language.stories import Visitor
from lumen.ports import Bus, FeelsTouch, Hall, HasCharger, HearsVisitors, Message, Robot
from lumen.robot.command_receiver import CommandListener
from lumen.robot.robot_routes import HALL_ROUTE, SEEN_ROUTE, publish_on
from lumen.robot.server import RobotServer
from lumen.upkeep.threads import MessageGuard

FACE_REPORT_PERIOD = 0.1
"""The shortest time between two messages about the visitor's face [s]."""
MAX_VISITOR_DISTANCE, MAX_VISITOR_HEIGHT = 100.0, 3.0

_log = logging.getLogger(__name__)


class RobotHost(CommandListener):
    """Lumen Server for a robot, and for the hall around the robot if the hall is simulated.

    The owner of the clock calls `tick`, which publishes and returns the robot's answers and perceptions since the last
    call. `listeners` are notified of commands from the bus.
    """

    def __init__(
        self,
        project: Project,
        robot: Robot,
        bus: Bus,
        hall: Hall | None = None,
        listeners: Sequence[CommandListener] = (),
    ) -> None:
        self.server = RobotServer(project, robot, bus, listeners=(self, *listeners))
        self._robot, self._bus, self._hall, self._project = robot, bus, hall, project
        self._visitor_messages: deque[Message] = deque(maxlen=1_000)
        self._guard = MessageGuard(_log, "the hall")
        self._seen: object = ()
        self._looked = -FACE_REPORT_PERIOD
        self._happened: list[Event] = []
        self._key = project.key_of(HALL_ROUTE)
        self._undo: Callable[[], None] = lambda: None
        if hall:
            self._undo = bus.subscribe(self._key, self._visitor_messages.append)

    def use(self, project: Project) -> None:
        """Switch to another bundle; the new key of the hall is subscribed before the old one is given up."""
        self._project, key = project, project.key_of(HALL_ROUTE)
        if self._hall and key != self._key:
            undo, self._key = self._undo, key
            self._undo = self._bus.subscribe(key, self._visitor_messages.append)
            undo()
        self.server.use(project)

    def tick(self, now: float) -> list[Event]:
        """Apply visitors' actions, publish due senses, begin commands, and publish and return the robot's events."""
        while self._visitor_messages and self._hall:
            message = self._visitor_messages.popleft()
            with self._guard(message.key):
                try:
                    self._apply(self._hall, message.body, now)
                except LumenError as error:
                    _log.warning("an action of the visitor was refused: %s", error)
        self.server.sample(now)
        events = [*self._robot.poll(), *self._happened]
        self._happened = []
        for event in events:
            self.server.answer(event)
        if self._hall and now >= self._looked + FACE_REPORT_PERIOD:
            self._look(self._hall, now)
        return events

    @property
    def waiting(self) -> bool:
        """True if messages about visitors, or events to publish, wait for the next tick."""
        return bool(self._visitor_messages or self._happened)

    def noticed(self, event: Event) -> None:
        self.notice(event)

    def notice(self, event: Event) -> None:
        """Publish an event at the next tick, as if the robot had noticed it."""
        self._happened.append(event)

    def close(self) -> None:
        self._undo()
        self.server.close()

    def _apply(self, hall: Hall, body: Any, now: float) -> None:
        match body:
            case {"visitor": None}:
                hall.place(None)
            case {"visitor": dict(place)} if (visitor := _visitor(place)) is not None:
                hall.place(visitor)
            case {"sensor": str(sensor), "pressed": bool(pressed)} if isinstance(hall, FeelsTouch):
                hall.touch(sensor, pressed)
            case {"sound": True}:
                if isinstance(hall, HearsVisitors):
                    hall.sound()
            case {"plugged": bool(plugged)} if isinstance(hall, HasCharger):
                hall.plug(plugged)
            case {"event": str(name)} if name in robot_events():
                self.notice(Event(name, body.get("data"), now))
            case _:
                _log.warning("an action of the visitor was refused: this hall has no action %s", str(body)[:80])

    def _look(self, hall: Hall, now: float) -> None:
        face = hall.face()
        if face == self._seen:
            return
        self._seen, self._looked = face, now
        try:
            publish_on(
                self._bus, self._project, SEEN_ROUTE, {"face": list(face) if face else None, "time": now}, ttl=1.0
            )
        except BusError as error:
            _log.warning("the visitor's face was not sent: %s", error)


def _visitor(place: Mapping[str, Any]) -> Visitor | None:
    """Return the visitor that a message places in the hall; None if its numbers are missing or out of range."""
    names = [field.name for field in fields(Visitor)]
    numbers = [place.get(name) for name in names]
    if not all(map(is_finite_number, numbers)):
        return None
    x, y, height = (float(number) for number in numbers if number is not None)
    near = abs(x) <= MAX_VISITOR_DISTANCE and abs(y) <= MAX_VISITOR_DISTANCE and 0.0 < height <= MAX_VISITOR_HEIGHT
    return Visitor(x, y, height) if near else None
