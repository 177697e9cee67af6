"""Controllers that move no joints: their inputs are messages and the context, their outputs signals and events."""

from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

from lumen.fuzzy.regulation import Regulator, RouteField
from lumen.language.commands import Command, Start, Track, Volume
from lumen.language.controllers import MessageBinding
from lumen.language.events import Event
from lumen.language.json_paths import schema_at
from lumen.language.projects import Project
from lumen.ports import Bus
from lumen.run.inbox import RouteInbox
from lumen.statechart import Snapshot


class Regulated(NamedTuple):
    """The output of controllers."""

    commands: tuple[Command, ...]
    """Commands to perform."""
    events: tuple[Event, ...]
    """Events to raise."""


class Regulation:
    """The regulators that are on, with their inputs from the bus and the behaviour's context.

    It is separate from the behaviour, in one process or several: a controller changes a context by an event, which is
    processed, observed and recorded like any other.
    """

    def __init__(self, project: Project, bus: Bus) -> None:
        self._inbox = RouteInbox(bus)
        self._on: dict[str, Regulator] = {}
        self._project = project
        self._volumes = 0
        self.reload(project)

    def reload(self, project: Project) -> None:
        """Switch to another bundle; a changed controller that is on keeps its inputs and past outputs."""
        self._project = project
        for name, before in list(self._on.items()):
            controller = project.controllers.get(name)
            if controller is None or not controller.signals:
                del self._on[name]
            elif controller != before.controller:
                self._on[name] = Regulator(controller, whole_fields(project))
                self._on[name].succeed(before)
        self._listen()

    def switch(self, track: Track) -> None:
        """Switch a controller on or off; ignore one that is already on, and one that only moves joints."""
        if not track.on:
            self._on.pop(track.controller, None)
        elif track.controller not in self._on:
            controller = self._project.controllers.get(track.controller)
            if controller and controller.signals:
                self._on[track.controller] = Regulator(controller, whole_fields(self._project))
        self._listen()

    def tick(self, now: float, snapshot: Snapshot) -> Regulated:
        """Read the inputs, and return the outputs that are due at `now` [s]."""
        for route, message in self._inbox.taken():
            for regulator in self._on.values():
                regulator.take(route, message.body)
        commands: list[Command] = []
        events: list[Event] = []
        contexts = tuple(_contexts(snapshot)) if self._on else ()
        for regulator in self._on.values():
            regulator.know(contexts)
            volume, messages, raised = regulator.signals(now)
            if volume is not None:
                self._volumes += 1
                commands.append(Start(f"volume{self._volumes}", Volume(volume)))
            commands += messages
            events += raised
        return Regulated(tuple(commands), tuple(events))

    def _listen(self) -> None:
        """Subscribe to the routes of the controllers that are on."""
        self._inbox.listen(self._project, {name for regulator in self._on.values() for name in regulator.routes})


def whole_fields(project: Project) -> frozenset[RouteField]:
    """Return the message fields that are bound to outputs, and by their schemas hold only integers."""
    bound = {
        (signal.route, *signal.path)
        for controller in project.controllers.values()
        for signal in controller.signals
        if isinstance(signal, MessageBinding)
    }
    return frozenset(field for field in bound if _schema(project, field).get("type") == "integer")


def _schema(project: Project, field: RouteField) -> Mapping[str, Any]:
    """Return the schema of a message field, else an empty one."""
    route, *path = field
    row = project.routes.get(route)
    schema = schema_at(project.messages.get(row.schema) if row else None, path)
    return schema if isinstance(schema, Mapping) else {}


def _contexts(snapshot: Snapshot) -> Iterator[Mapping[str, Any]]:
    """Yield the context of a behaviour, then those of the behaviours that it invoked."""
    yield snapshot.context
    for child in snapshot.invoked.values():
        yield from _contexts(child.snapshot)
