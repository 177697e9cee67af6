"""Executable content and data, as simply as can be: what actions do to a plain, changeable world."""

from collections.abc import Mapping
from copy import deepcopy
from dataclasses import dataclass, field
from typing import Any

from lumen.errors import ExpressionError
from lumen.expressions import Scope, compile_expression, compile_guard, compile_template
from lumen.language.actions import Assign, CancelSend, ComputedValue, Expression, If, LogText, PlacedAction, Raise, Send
from lumen.language.commands import Command, Log, Play, Start
from lumen.language.diagnostics import NodePath
from lumen.language.events import Event
from lumen.language.machines import MachineDefinition, State

LIMIT = 1000
"""Microsteps and internal events of a macrostep; the interpreter promises to give up after as many."""

Where = NodePath


class FaultError(Exception):
    """An action can't be done."""


class RestlessError(Exception):
    """The machine never comes to rest."""


@dataclass
class Waiting:
    """A timer: of an `after` if it has a state, else of a `send`; due [s] to the nanosecond."""

    event: str
    due: float
    data: Any = None
    state: str | None = None
    id: str = ""

    def __post_init__(self) -> None:
        self.due = round(self.due, 9)


@dataclass
class World:
    """Everything that a machine changes while it runs."""

    machine: MachineDefinition
    context: dict[str, Any]
    configuration: list[State] = field(default_factory=list)
    history: dict[str, list[State]] = field(default_factory=dict)
    timers: list[Waiting] = field(default_factory=list)
    internal: list[Event] = field(default_factory=list)
    raised: list[Event] = field(default_factory=list)
    commands: list[Command] = field(default_factory=list)
    failed: list[Where] = field(default_factory=list)
    event: Event | None = None
    at: float = 0.0
    started: int = 0

    def scope(self, here: State) -> Scope:
        """Return the scope of an expression in that state."""
        event = {"name": self.event.name, "data": self.event.data} if self.event else None
        names = {name for s in self.configuration for name in (s.path, s.alias) if s.path and name}
        return Scope(dict(self.context), event, {"path": here.path, "language": ""}, names.__contains__, self.at)

    def enqueue(self, event: Event) -> None:
        self.internal.append(event)
        self.raised.append(event)

    def fail(self, where: Where) -> None:
        """Raise `error.execution`, once for a place while that very event is being handled."""
        if not (self.event and self.event.name == "error.execution" and where in self.failed):
            self.failed.append(where)
            self.enqueue(Event("error.execution", {"where": ".".join(map(str, where))}, self.at))

    def holds(self, guard: Expression, here: State) -> bool:
        """`conditionMatch`: a condition that fails is false."""
        try:
            return compile_guard(guard.source)(self.scope(here))
        except ExpressionError:
            self.fail(guard.where)
            return False

    def value(self, value: ComputedValue, here: State) -> Any:
        match value:
            case Expression(source):
                return compile_expression(source)(self.scope(here))
            case tuple():
                return [self.value(item, here) for item in value]
            case Mapping():
                return {key: self.value(item, here) for key, item in value.items()}
        return value

    def execute(self, block: tuple[PlacedAction, ...], here: State) -> None:
        """`executeContent`: the first action that fails ends the block."""
        for step in block:
            try:
                self.act(step, here)
            except (FaultError, ExpressionError):
                self.fail(step.where)
                return

    def act(self, step: PlacedAction, here: State) -> None:
        match step.action:
            case Assign(values):
                before = dict(self.context)
                try:
                    for way, value in values.items():
                        self.put(way.split("."), self.value(value, here))
                except (FaultError, ExpressionError):
                    self.context = before
                    raise
            case Raise(event, data):
                self.enqueue(Event(event, self.value(data, here), self.at))
            case Send(event, data, delay, id):
                assert isinstance(delay, float)  # the generator computes none
                self.timers.append(Waiting(event, self.at + delay, self.value(data, here), None, id))
            case CancelSend(id):
                self.timers = [t for t in self.timers if t.state is not None or t.id != id]
            case LogText(template):
                self.commands.append(Log(compile_template(template.text)(self.scope(here))))
            case If(guard, then, otherwise):
                for inner in then if compile_guard(guard.source)(self.scope(here)) else otherwise:
                    self.act(inner, here)
            case Play() as play:
                self.started += 1
                self.commands.append(Start(f"c{self.started}", play))
            case other:
                raise NotImplementedError(other)

    def put(self, way: list[str], value: Any) -> None:
        """Set a key of the context, or one within its maps, in a copy of the context."""
        world = deepcopy(self.context)
        place: Any = world
        for key in way[:-1]:
            place = place.get(key)
            if not isinstance(place, dict):
                raise FaultError(key)
        place[way[-1]] = value
        self.store(way[0], world[way[0]])

    def store(self, key: str, value: Any) -> None:
        """Set a key of the context. Raises FaultError if its first value is of another type and not null."""
        first = self.machine.context[key]
        if first is not None and _type(first) != _type(value):
            raise FaultError(key)
        self.context[key] = value


def _type(value: Any) -> str:
    names = {bool: "boolean", int: "number", float: "number", str: "text", type(None): "null"}
    return names.get(type(value), "list" if isinstance(value, list | tuple) else "map")
