"""Lumen Server: the robot's senses on the bus, each on a thread of its own, while commands execute."""

import logging
import time
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from itertools import count
from math import inf
from typing import Any

from lumen.errors import BusError
from lumen.feature import table
from lumen.language.causes import UNKNOWN_ORIGIN, MessageOrigin
from lumen.language.commands import Say
from lumen.language.events import RECORDED, Event
from lumen.language.iso_time import iso_time
from lumen.language.projects import Project
from lumen.language.routes import Route
from lumen.ports import Bus, HasOtherSenses, Image, KnowsListeners, OtherReading, Robot, RobotCommand, Sense
from lumen.robot.command_receiver import CommandListener, CommandReceiver
from lumen.robot.deduplication_log import DeduplicationLog
from lumen.robot.robot_routes import NOTICED_ROUTE, RECORDING_ROUTE, TEXT_ROUTE, publish_on
from lumen.robot.sense_codec import encode_reading, image_body
from lumen.robot.sense_publisher import PendingReading, PublishCounts, SensePublisher

DEFAULT_SENSE_PERIOD = 0.1
SENSES_CLOSE_TIMEOUT = 5.0
TIME_EPSILON = 1e-9
SETTLE_TIMEOUT = 0.02
THREAD_START_TIMEOUT = FIRST_IMAGE_TIMEOUT = 1.0

_log = logging.getLogger(__name__)


def _date() -> str:
    return iso_time(time.time(), offset=True)


class RobotServer:
    """A robot on a bus, as the project's routes `image`, `joint`, `sonar`, `tactile` and `battery` say.

    The owner of the clock calls `sample` at each tick, which reads the senses that are due and begins the commands that
    have arrived, without waiting. Readings except images are sent in the order they were taken, so a simulation with
    one seed sends the same messages in the same order. `settle` waits for them, and once for a first image, which takes
    as long as several others because it starts OpenGL.

    `date` returns the date of images. `clock` measures the wait of commands [s] by the modules' time, whatever the
    robot's clock shows. `listeners` are notified of commands from the bus. A robot that a person stopped does not move
    (`hold`). With `direct`, `sample` itself publishes readings except images, for clocks that wait for the receivers:
    threads would have to switch at every tick.
    """

    def __init__(
        self,
        project: Project,
        robot: Robot,
        bus: Bus,
        *,
        date: Callable[[], str] = _date,
        clock: Callable[[], float] = time.monotonic,
        listeners: Sequence[CommandListener] = (),
        direct: bool = False,
    ) -> None:
        self._robot, self._bus, self._direct = robot, bus, direct
        self._listeners = bus.ability(KnowsListeners)
        self._frames, self._date = count(), date
        self._project = project
        self._routes: dict[str, Route] = {}
        self._next: dict[str, float] = {}
        self._broadcasts: dict[str, SensePublisher] = {}
        self._leaving: list[PendingReading] = []
        self._first_image: PendingReading | None = None
        self._seen = False
        self._listen(project)
        self._orders = CommandReceiver(project, robot, bus, clock, (*listeners, _Speech(self)))
        self.hold = self._orders.hold
        self._closed = False

    def recall(self, begun_before: DeduplicationLog) -> None:
        """Refuse commands that the previous process had begun, and record those that begin from now on."""
        self._orders.recall(begun_before)

    def resume(self, by: str) -> None:
        """Let a robot move that a person stopped; it stands up if the behaviour has no transition for `resume`."""
        self._orders.resume(by)

    @property
    def counts(self) -> Mapping[str, PublishCounts]:
        """The counts of readings by route: the route of each sense, and each route that is `of` a sense."""
        return {name: broadcast.count for name, broadcast in self._broadcasts.items()}

    @property
    def due(self) -> float:
        """When the next reading is due [s]; infinite if no sense is on."""
        return min((self._next[name] for name in self._routes if not self._broadcasts[name].count.off), default=inf)

    @property
    def waiting(self) -> bool:
        """True while commands wait to begin."""
        return self._orders.waiting

    def sample(self, now: float) -> None:
        """Read and publish the senses that are due at `now` [s]; begin the commands that have arrived.

        A route whose sense is off is skipped. So is a route without subscribers if it carries images or is `of` a
        sense.
        """
        for name, route in self._routes.items():
            if now + TIME_EPSILON >= self._next[name] and not self._broadcasts[name].count.off:
                self._schedule(name, route, now)
                if self._wanted(route):
                    self._read(name, route.sense)
        self._orders.begin()

    def use(self, project: Project) -> None:
        """Switch to another bundle: its routes and periods from the next sample on, its motions for new commands.

        A sense that was switched off after an error is tried again.
        """
        self._listen(project)
        for broadcast in self._broadcasts.values():
            broadcast.arm()
        self._orders.use(project)

    def settle(self, patience: float = SETTLE_TIMEOUT) -> bool:
        """Wait until every reading except images has been published; return False if that takes too long.

        Publishing may take `patience` [s] altogether, so that a slow subscriber does not block the caller. The time
        until the machine has started a thread does not count, because the order of messages would otherwise depend
        on the load of the machine.
        """
        first, self._first_image = self._first_image, None
        if first:
            first.done.wait(FIRST_IMAGE_TIMEOUT)
        for handed in self._leaving:
            if not handed.begun.wait(THREAD_START_TIMEOUT):
                return False
            arrived = time.monotonic()
            if not handed.done.wait(max(0.0, min(patience, handed.began + patience - arrived))):
                return False
            patience -= time.monotonic() - arrived
        return True

    def answer(self, event: Event) -> bool:
        """Pass on an event of the robot: reports of a command to its sender, recordings and perceptions to all.

        Return True if it was about a command from the bus.
        """
        self.hold.feel(event)
        if ".command." in event.name:
            return self._orders.answer(event)
        if event.name == RECORDED:
            self._tell(RECORDING_ROUTE, event.data)
            return False
        self._tell(NOTICED_ROUTE, {"name": event.name, "data": event.data, "time": event.at})
        return False

    def begins(self, command: RobotCommand, id: str = "") -> None:
        """Publish the text of a speech command that the robot begins under that id, for an external voice."""
        if isinstance(command, Say) and TEXT_ROUTE in self._project.routes:
            body = {"name": self._project.robot, "text": command.text, "date": self._date()}
            self._tell(TEXT_ROUTE, {**body, "language": command.language}, MessageOrigin(cause=id))

    def close(self) -> None:
        """Publish the readings that were taken and end the threads; repeated calls do nothing."""
        if self._closed:
            return
        self._closed = True
        self._orders.close()
        deadline = time.monotonic() + SENSES_CLOSE_TIMEOUT
        ended = [b.close(deadline - time.monotonic()) for b in self._broadcasts.values()]
        if not all(ended):
            _log.warning("a sense is still running %g s after it was closed", SENSES_CLOSE_TIMEOUT)

    def _tell(self, route: str, body: dict[str, Any], origin: MessageOrigin = UNKNOWN_ORIGIN) -> None:
        try:
            publish_on(self._bus, self._project, route, body, origin=origin)
        except BusError as error:
            _log.warning("a message of the robot on `%s` was not sent: %s", route, error)

    def _wanted(self, route: Route) -> bool:
        """Return False for a reading that nobody needs: an image, or a route `of` a sense, without subscribers."""
        if not route.of and route.sense != Sense.IMAGE:
            return True
        return self._listeners is None or self._listeners.heard(route.key_for(self._project.robot))

    def _schedule(self, name: str, route: Route, now: float) -> None:
        """Set the next time on the grid of the sense's period; a period from now if ticks are coarser than that."""
        period = route.every or DEFAULT_SENSE_PERIOD
        self._next[name] += period
        if self._next[name] <= now:
            self._next[name] = now + period

    def _read(self, name: str, sense: str) -> None:
        reading = self._robot.read(Sense(sense)) if sense in set(Sense) else self._other(sense)
        if reading is None:
            return
        if isinstance(reading, Image):
            handed = PendingReading(reading)
            if not self._seen:
                self._first_image, self._seen = handed, True
            self._broadcasts[name].hand(handed)
            return
        self._leaving = [handed for handed in self._leaving if not handed.done.is_set()]
        handed = PendingReading(reading, self._leaving[-1] if self._leaving else None)
        self._leaving.append(handed)
        self._broadcasts[name].hand(handed)

    def _other(self, sense: str) -> OtherReading | None:
        return self._robot.read_other(sense) if isinstance(self._robot, HasOtherSenses) else None

    def _listen(self, project: Project) -> None:
        """Give each route of a sense a publisher; routes `of` a sense come after the routes named after senses."""
        self._project = project
        senses = {sense: i for i, sense in enumerate(table("senses"))}
        rows = [(name, route) for name, route in project.routes.items() if route.sense in senses]
        self._routes = dict(sorted(rows, key=lambda row: (bool(row[1].of), senses[row[1].sense])))
        for name, route in self._routes.items():
            if name not in self._broadcasts:
                image = route.sense == Sense.IMAGE
                encode = partial(self._picture, name) if image else partial(encode_reading, route.sense)
                publish, direct = partial(self._publish, name), self._direct and not image
                self._broadcasts[name] = SensePublisher(name, encode, publish, direct=direct)
                self._next[name] = 0.0

    def _publish(self, name: str, body: dict[str, Any]) -> None:
        if route := self._routes.get(name):
            self._bus.publish(route.key_for(self._project.robot), body, ttl=route.ttl)

    def _picture(self, name: str, image: Image) -> dict[str, Any]:
        route, eyes = self._routes.get(name), self._project.body.roles.eyes
        camera = eyes.camera if eyes else ""
        return image_body(image, next(self._frames), self._date(), route.size if route else None, camera)


class _Speech(CommandListener):
    """Publishes the texts of speech commands from the bus."""

    def __init__(self, server: RobotServer) -> None:
        self._server = server

    def given(self, command: RobotCommand, id: str) -> None:
        self._server.begins(command, id)
