"""What a macrostep holds while it is made: the only thing that changes, and it is gone when the step is there."""

from collections import deque
from collections.abc import Container, Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple, Protocol, Self

from lumen.expressions import Scope
from lumen.language.actions import PARENT
from lumen.language.commands import BodyCommand, Command, Start
from lumen.language.diagnostics import NodePath
from lumen.language.events import ARRIVED, LEFT, Event
from lumen.language.machines import Transition
from lumen.language.nanoseconds import nanoseconds
from lumen.statechart.action_context import ActionError
from lumen.statechart.activities import Activities
from lumen.statechart.chart import CompiledInvoke, StateNode
from lumen.statechart.compiled_machine import CompiledMachine
from lumen.statechart.drawing import draw
from lumen.statechart.plans import Configuration
from lumen.statechart.values import MAX_TIMERS, Counters, Halted, Invoked, Snapshot, Step, Timer

_new = tuple.__new__  # a third of the price of Scope(…), Snapshot(…), Step(…)


class Beginning(NamedTuple):
    """What a state begins when the macrostep is done: its invocations, then its `do` (SCXML 6.4: `statesToInvoke`).

    `halted` is where that `do` stood, for a state that a history leads back into.
    """

    node: StateNode
    invokes: tuple[CompiledInvoke, ...]
    do: bool
    halted: Halted | None = None


def place_after(before: str, event: Event | None) -> str:
    """Where the robot is after an event from outside: `arrived` and `left` say it, no other does."""
    if event is None or event.name not in (ARRIVED, LEFT) or not isinstance(event.data, Mapping):
        return before
    place = event.data.get("place")
    if not isinstance(place, str):
        return before
    return place if event.name == ARRIVED else before if place != before else ""


class InvocationHandler(Protocol):
    """What the algorithm asks of the behaviours that run within a machine; `steps` are those they took in this one."""

    children: Mapping[str, Invoked]
    steps: tuple[tuple[str, Step], ...]

    def begin(self, context: "ExecutionContext", node: StateNode, invoke: CompiledInvoke) -> None:
        """Invoke a behaviour (`invoke`)."""

    def cancel(self, context: "ExecutionContext", node: StateNode) -> None:
        """End what a state that is left has invoked (`cancelInvoke`)."""

    def forward(self, context: "ExecutionContext", event: Event) -> None:
        """Let all of them hear an event."""

    def deliver(self, context: "ExecutionContext", id: str, event: Event) -> None:
        """Let one of them hear an event."""

    def post(self, context: "ExecutionContext") -> None:
        """Hand over what the machine sends to them."""

    def listens(self, context: "ExecutionContext", name: str) -> bool:
        """Whether one of them waits for an event of that name now."""


@dataclass(slots=True, eq=False)
class ExecutionContext:
    """A snapshot being moved on by one event.

    `trigger` is the event that began the macrostep, `event` the one being handled; `active` is what `In` asks, and
    `node` the state that expressions know as `state`. `unforwarded` is an event from outside that invoked behaviours
    have not heard yet, `beginnings` are the states entered and not left, `failed` the places of errors. `outbox` is
    what goes to invoked behaviours, and to which; `for_parent` what goes to that which invoked this, if any.
    """

    machine: CompiledMachine
    trigger: Event | None
    event: Event | None
    at: float
    configuration: Configuration
    active: Container[str]
    node: StateNode
    data: Mapping[str, Any]
    language: str
    timers: tuple[Timer, ...]
    history: Mapping[str, tuple[str, ...]]
    counters: Counters
    generator: int
    epoch: float
    timezone: str
    activities: Activities
    invocations: InvocationHandler
    place: str = ""
    event_data: Mapping[str, Any] | None = None
    cached_scope: Scope | None = None
    internal_queue: deque[Event] | tuple[()] = ()
    unforwarded: Event | None = None
    beginnings: tuple[Beginning, ...] = ()
    is_invoked: bool = False
    for_parent: tuple[Event, ...] = ()
    outbox: tuple[tuple[str, Event], ...] = ()
    microsteps: int = 0
    failed: frozenset[NodePath] = frozenset()
    output: Any = None
    commands: tuple[Command, ...] = ()
    exited: tuple[str, ...] = ()
    entered: tuple[str, ...] = ()
    transitions: tuple[Transition, ...] = ()
    raised: tuple[Event, ...] = ()

    @classmethod
    def of(
        cls,
        machine: CompiledMachine,
        snapshot: Snapshot,
        event: Event | None,
        at: float,
        invocations: InvocationHandler,
    ) -> Self:
        """The context of a macrostep from that snapshot at `at` [s]; raises KeyError with a state that is unknown."""
        (
            names, data, _, language, timers, doing, history, counters, generator, epoch, _, halted, place, zone,
            output,
        ) = snapshot  # fmt: skip
        start = machine.planner.configuration(names)
        return cls(
            machine, event, event, at, start, start.known, machine.chart.root, data, language, timers, history,
            counters, generator, epoch, zone, Activities(doing, halted), invocations, place_after(place, event),
            output=output,
        )  # fmt: skip

    def within(
        self, id: str, machine: CompiledMachine, snapshot: Snapshot, event: Event | None, invocations: InvocationHandler
    ) -> Self:
        """The context of a behaviour that runs within this one, under that id."""
        child = type(self).of(machine, snapshot, event, self.at, invocations)
        child.is_invoked = True
        return child

    def step(self) -> Step:
        """The step that was made; the context is of no use after it."""
        self.cached_scope = None  # which refers to this context: no need to wait for the garbage collector
        after = (
            self.configuration.names, self.data, self.at, self.language, self.timers, self.activities.positions,
            self.history, self.counters, self.generator, self.epoch, self.invocations.children, self.activities.halted,
            self.place, self.timezone, self.output,
        )  # fmt: skip
        made = (
            self.trigger, self.exited, self.entered, self.commands, _new(Snapshot, after), self.transitions,
            self.raised, self.invocations.steps,
        )  # fmt: skip
        return _new(Step, made)

    def take_internal(self) -> Event:
        """Handle the next event of the internal queue from now on."""
        event = self.internal_queue.popleft()  # type: ignore[union-attr]  # whoever calls this has looked
        self.event, self.event_data, self.cached_scope = event, None, None
        return event

    def leave(self, transitions: tuple[Transition, ...], exited: tuple[str, ...], entered: tuple[str, ...]) -> None:
        """Begin a microstep with these transitions; the names are those of the states that it exits and enters."""
        self.transitions += transitions
        self.exited += exited
        self.entered += entered

    def reach(self, target: Configuration) -> None:
        """End a microstep: these states are active now."""
        self.configuration, self.active = target, target.known

    def evaluate_in(self, node: StateNode) -> None:
        """Let `state` in expressions be this one."""
        if node is not self.node:
            self.node, self.cached_scope = node, None

    def scope(self) -> Scope:
        """What an expression sees now."""
        scope = self.cached_scope
        if scope is None:
            event, definition = self.event, self.machine.chart.definition
            if event is not None and self.event_data is None:
                self.event_data = {"name": event.name, "data": event.data}
            seen = (
                self.data, self.event_data, self.node.view(self.language, self.place), self.is_active, self.at,
                self.language, definition.phrases, definition.answers, self.epoch, self.timezone,
                definition.lists, self.draw, definition,
            )  # fmt: skip
            scope = self.cached_scope = _new(Scope, seen)
        return scope

    def is_active(self, state: str) -> bool:
        """`In()`: asks when it is called, so that a scope serves while states come and go."""
        return state in self.active

    def offers(self, event: str) -> bool:
        """Whether an active state has a transition for just that event that is an `offer`, and asks for no approval."""
        found = (transition.definition for group in self.configuration.candidates(event) for transition in group)
        return any(one.offer and not one.approve and one.event == event for one in found)

    def assign(self, key: str, value: Any) -> None:
        """Give a context key another value; raises ActionError where it is of another type."""
        check = self.machine.chart.checks.get(key)
        if check and type(value) not in check.quick and not check.accepts(value):
            raise ActionError(f"`{key}` {check.refusal(value, 'become')}")
        self.data = {**self.data, key: value}
        self.cached_scope = None

    def draw(self, count: int) -> int:
        """One of `count` alternatives, from the generator."""
        drawn, self.generator = draw(self.generator, count)
        return drawn

    def emit(self, command: Command) -> None:
        """Something for the edge to perform."""
        self.commands = (*self.commands, command)

    def start(self, command: BodyCommand, *, awaited: bool = False) -> str:
        """Start a command; its id."""
        commands, waited, timers = self.counters
        if awaited:
            id = f"d{waited + 1}"
            self.counters = Counters(commands, waited + 1, timers)
        else:
            id = f"c{commands + 1}"
            self.counters = Counters(commands + 1, waited, timers)
        self.emit(Start(id, command))
        return id

    def send(self, id: str, delay: float, event: str, data: Any, to: str) -> None:
        """A `send`: due after `delay` [s], at the earliest in the next macrostep (SCXML 6.2).

        What goes to another behaviour without delay is handed over in this macrostep. Raises ActionError where
        MAX_TIMERS wait already.
        """
        length = nanoseconds(delay)
        if to and not length:
            self.hand_over(to, Event(event, data, self.at))
            return
        if len(self.timers) >= MAX_TIMERS:
            raise ActionError(f"`{event}` is not sent: {MAX_TIMERS:,} timers are already waiting")
        due = nanoseconds(self.at) + length
        timer = Timer(id or self._timer_id("s"), due, length, event, data, to=to)
        self.timers = (*self.timers, timer)

    def hand_over(self, to: str, event: Event) -> None:
        """Have the behaviour that invoked this one, one that it invokes, or another robot hear an event."""
        if to == PARENT and self.is_invoked:
            self.for_parent = (*self.for_parent, event)
        else:
            self.outbox = (*self.outbox, (to, event))

    def returned(self, to: str, event: Event) -> None:
        """Raise error.communication: there is nobody to whom that could be sent (SCXML 6.2.5)."""
        whom = "no behaviour invoked this one" if to == PARENT else f"no behaviour `{to}` is invoked here now"
        reason = f"{whom}: `{event.name}` has no recipient"
        self.raise_event(Event("error.communication", {"to": to, "reason": reason}, self.at))

    def cancel_send(self, id: str) -> None:
        """Take back what was sent under that id and is not due yet (SCXML 6.3)."""
        self.timers = tuple(t for t in self.timers if t.kind != "send" or t.id != id)

    def wait(self, seconds: float) -> str:
        """A `wait` of the `do` of the state that is evaluated in; its id."""
        id, length = self._timer_id("w"), nanoseconds(seconds)
        timer = Timer(id, nanoseconds(self.at) + length, length, f"wait.{id}", None, self.node.path, "wait")
        self.timers = (*self.timers, timer)
        return id

    def _timer_id(self, letter: str) -> str:
        self.counters = self.counters._replace(timers=self.counters.timers + 1)
        return f"{letter}{self.counters.timers}"

    def raise_event(self, event: Event) -> None:
        """Append to the internal queue (SCXML 4.2)."""
        if not self.internal_queue:
            self.internal_queue = deque()
        self.internal_queue.append(event)
        self.raised += (event,)

    def raise_error(self, reason: str, where: NodePath) -> None:
        """Raise error.execution; not again for the same place while that is what is being handled."""
        handling = self.event is not None and self.event.name == "error.execution"
        if not (handling and where in self.failed):
            self.failed |= {where}
            place = ".".join(map(str, where))
            self.raise_event(Event("error.execution", {"reason": reason, "where": place}, self.at))
