"""The robot: its senses on the bus, and a face detector if the hall around it is simulated."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from math import inf
from pathlib import Path

from lumen.clock.checked import ability
from lumen.feature import table
from lumen.language.commands import Command, Say, Start
from lumen.language.events import Event
from lumen.language.modules import EYES
from lumen.language.projects import Project
from lumen.ports import Bus, HasSpeed
from lumen.robot.bounded_robot import is_idle
from lumen.robot.command_receiver import CommandListener
from lumen.robot.deduplication_log import DeduplicationLog
from lumen.robot.sense_publisher import PublishCounts
from lumen.robot.server import RobotServer
from lumen.run.loop import Observer
from lumen.run.parts.kept_hold import KeptHold
from lumen.run.parts.part import Part
from lumen.run.perception import FaceDetector
from lumen.run.presence import ROBOT_PART, Presence
from lumen.run.setup import Setup


@dataclass(frozen=True, slots=True)
class RunBefore:
    """Traces of the previous run."""

    kept: KeptHold | None = None
    """Holds the robot if a person had stopped it."""
    begun: Path | None = None
    """The file of the commands that must not be performed again."""


NO_RUN = RunBefore()


class RobotPart(Part, Observer):
    """A robot that this node's brain commands directly; modules command it through `server`.

    `listeners` are notified of commands from elsewhere. The part observes the brain's loop, and publishes the robot's
    speech and answers. On a bus of its own a tick waits until the readings are published, so that runs are
    reproducible; at unlimited speed the tick publishes them itself. A `silent` robot publishes only the senses that the
    behaviour uses, as events or in controllers.
    """

    name = ROBOT_PART
    watches = True

    def __init__(
        self,
        project: Project,
        bus: Bus,
        setup: Setup,
        listeners: Sequence[CommandListener] = (),
        presence: Presence | None = None,
        *,
        server: RobotServer | None = None,
        silent: bool = False,
        before: RunBefore = NO_RUN,
    ) -> None:
        self._silent, self._presence, self._before = silent, presence, before
        self.robot = setup.robot
        paced = ability(setup.clock, HasSpeed)
        self.server = server or RobotServer(
            self._sensed(project),
            setup.robot,
            bus,
            listeners=(*listeners, Urgency(setup), *filter(None, [before.kept])),
            direct=presence is None and paced is not None and paced.speed is None,
        )
        self.faces = FaceDetector(project, setup.hall, bus) if setup.hall else None

    def begin(self, now: float) -> None:
        if self._before.begun:
            self.server.recall(DeduplicationLog(self._before.begun))
        if self._before.kept:
            self._before.kept.restore(self.server.hold)

    def tick(self, now: float, changes: Sequence[Event]) -> None:
        self.server.sample(now)
        if self._presence is None:
            self.server.settle()
        self._look(now)

    def quiet_until(self, now: float) -> float:
        """Return when a sense is next due [s]; `now` while the robot, a face or a waiting command needs every tick."""
        server = self.server  # if silent, only controllers read senses, and the brain ticks for them
        if server.waiting or (self.faces and self.faces.busy) or not is_idle(self.robot):
            return now
        return inf if self._silent else max(now, server.due)

    def leap(self, now: float) -> None:
        if self.faces:
            self.faces.leap(now)

    def use(self, project: Project) -> None:
        self.server.use(self._sensed(project))
        if self.faces:
            self.faces.use(project)

    def performing(self, command: Command, now: float) -> None:
        match command:
            case Start(id, Say() as said):
                self.server.begins(said, id)

    def answered(self, event: Event) -> None:
        self.server.answer(event)

    @property
    def said(self) -> dict[str, str]:
        """The fields that the part adds to the presence of this process: none."""
        return {}

    def summary(self) -> Iterator[str]:
        yield "published: " + (", ".join(map(_counted, self.server.counts.items())) or "nothing")

    def close(self) -> None:
        try:
            self.server.close()
        finally:
            self.robot.close()

    def _sensed(self, project: Project) -> Project:
        """Return the project with only the routes of the senses that are published."""
        if not self._silent:
            return project
        read = {
            binding.route
            for controller in project.controllers.values()
            for binding in (controller.input_bindings if controller.signals else ())
        }
        routes = {
            name: route
            for name, route in project.routes.items()
            if name not in table("senses") or route.event or name in read
        }
        return replace(project, routes=routes)

    def _look(self, now: float) -> None:
        """Detect the visitor's face, unless a process with eyes does."""
        if self.faces is None:
            return
        if self._presence and EYES not in self._presence.parts:
            self.faces.quiet = self._presence.find(EYES) is not None
        self.faces.tick(now)


class Urgency(CommandListener):
    """A listener that ends the wait of a robot's clock when a stop arrives."""

    def __init__(self, setup: Setup) -> None:
        self._setup = setup

    def urgent(self) -> None:
        self._setup.hurry()


def _counted(item: tuple[str, PublishCounts]) -> str:
    """Return a count of published readings, such as `1204 joint (3 dropped)`."""
    sense, count = item
    return f"{count.published} {sense}" + (f" ({count.dropped} dropped)" if count.dropped else "")
