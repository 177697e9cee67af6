"""The mutable state of one macrostep; it is discarded once the Step is made."""

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

_new = tuple.__new__  # saves two thirds of the cost of Scope(…), Snapshot(…) and Step(…)


class Beginning(NamedTuple):
    """The activities of an entered state, which begin after the macrostep (SCXML 6.4: `statesToInvoke`)."""

    node: StateNode
    invokes: tuple[CompiledInvoke, ...]
    """The behaviours to invoke."""
    do: bool
    """Whether the node's `do` begins."""
    halted: Halted | None = None
    """The stored position of that `do`, if a history state restores the state."""


def place_after(before: str, event: Event | None) -> str:
    """Return the robot's place after an event from outside; only `arrived` and `left` change it."""
    if event is None or event.name not in (ARRIVED, LEFT) or not isinstance(event.data, Mapping):
        return before
    place = event.data.get("place")
    if not isinstance(place, str):
        return before
    return place if event.name == ARRIVED else before if place != before else ""


class InvocationHandler(Protocol):
    """The operations of the algorithm on invoked behaviours."""

    children: Mapping[str, Invoked]
    """The invoked behaviours by the ids of their invokes."""
    steps: tuple[tuple[str, Step], ...]
    """The steps of invoked behaviours during this macrostep, each with the id of the invoke."""

    def begin(self, context: "ExecutionContext", node: StateNode, invoke: CompiledInvoke) -> None:
        """Start an invoked behaviour (`invoke`)."""

    def cancel(self, context: "ExecutionContext", node: StateNode) -> None:
        """End the behaviours that a left state has invoked (`cancelInvoke`)."""

    def forward(self, context: "ExecutionContext", event: Event) -> None:
        """Deliver an event to all invoked behaviours."""

    def deliver(self, context: "ExecutionContext", id: str, event: Event) -> None:
        """Deliver an event to the invoked behaviour of that id."""

    def post(self, context: "ExecutionContext") -> None:
        """Deliver the events that the machine has sent to behaviours and robots."""

    def listens(self, context: "ExecutionContext", name: str) -> bool:
        """Return True if an invoked behaviour has a transition for an event of that name now."""


@dataclass(slots=True, eq=False)
class ExecutionContext:
    """The state of a macrostep: a snapshot that one event is changing."""

    machine: CompiledMachine
    trigger: Event | None
    """The event that began the macrostep; None for the first."""
    event: Event | None
    """The event that is being processed."""
    at: float
    """The time of the macrostep [s]."""
    configuration: Configuration
    active: Container[str]
    """The names for which `In()` is true."""
    node: StateNode
    """The node that expressions read as `state`."""
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
    """An event from outside that has not been delivered to the invoked behaviours yet."""
    beginnings: tuple[Beginning, ...] = ()
    """The states that were entered and not left again, with the activities to begin in them."""
    is_invoked: bool = False
    for_parent: tuple[Event, ...] = ()
    """Events for the behaviour that invoked this one."""
    outbox: tuple[tuple[str, Event], ...] = ()
    """Events for invoked behaviours and other robots, each with its recipient."""
    microsteps: int = 0
    failed: frozenset[NodePath] = frozenset()
    """The places at which an error has been raised so far."""
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
        """Return the context of a macrostep at `at` [s]; raise KeyError with the name of an unknown state."""
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
        """Return the context of an invoked behaviour that runs inside this one under that id."""
        child = type(self).of(machine, snapshot, event, self.at, invocations)
        child.is_invoked = True
        return child

    def step(self) -> Step:
        """Return the finished step; the context must not be used afterwards."""
        self.cached_scope = None  # it refers to this context: without the cycle, no garbage collection is needed
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
        """Make the next event of the internal queue the current one and return it."""
        event = self.internal_queue.popleft()  # type: ignore[union-attr]  # callers check that it is not empty
        self.event, self.event_data, self.cached_scope = event, None, None
        return event

    def leave(self, transitions: tuple[Transition, ...], exited: tuple[str, ...], entered: tuple[str, ...]) -> None:
        """Begin a microstep: record its transitions and the names of the states that it exits and enters."""
        self.transitions += transitions
        self.exited += exited
        self.entered += entered

    def reach(self, target: Configuration) -> None:
        """End a microstep: these states are active now."""
        self.configuration, self.active = target, target.known

    def evaluate_in(self, node: StateNode) -> None:
        """Make this node the `state` that expressions read."""
        if node is not self.node:
            self.node, self.cached_scope = node, None

    def scope(self) -> Scope:
        """Return the values that an expression can read now."""
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
        """Return `In(state)`; evaluated on call, so that a scope stays valid while states are left and entered."""
        return state in self.active

    def offers(self, event: str) -> bool:
        """Return True if an active state has an `offer` transition for exactly that event that needs no approval."""
        found = (transition.definition for group in self.configuration.candidates(event) for transition in group)
        return any(one.offer and not one.approve and one.event == event for one in found)

    def assign(self, key: str, value: Any) -> None:
        """Set a context key; raise ActionError if the value does not have the key's type."""
        check = self.machine.chart.checks.get(key)
        if check and type(value) not in check.quick and not check.accepts(value):
            raise ActionError(f"`{key}` {check.refusal(value, 'become')}")
        self.data = {**self.data, key: value}
        self.cached_scope = None

    def draw(self, count: int) -> int:
        """Return a number from 0 to `count` - 1 and advance the generator."""
        drawn, self.generator = draw(self.generator, count)
        return drawn

    def emit(self, command: Command) -> None:
        """Append a command, which the runtime performs after the step."""
        self.commands = (*self.commands, command)

    def start(self, command: BodyCommand, *, awaited: bool = False) -> str:
        """Start a command and return its id: `d…` if it is `awaited`, else `c…`."""
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
        """Execute a `send`: it is due after `delay` [s], at the earliest in the next macrostep (SCXML 6.2).

        An event for another behaviour without delay is delivered in this macrostep. Raises ActionError if MAX_TIMERS
        are waiting already.
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
        """Queue an event for the invoking behaviour, an invoked one, or another robot."""
        if to == PARENT and self.is_invoked:
            self.for_parent = (*self.for_parent, event)
        else:
            self.outbox = (*self.outbox, (to, event))

    def returned(self, to: str, event: Event) -> None:
        """Raise error.communication for an event without a recipient (SCXML 6.2.5)."""
        whom = "no behaviour invoked this one" if to == PARENT else f"no behaviour `{to}` is invoked here now"
        reason = f"{whom}: `{event.name}` has no recipient"
        self.raise_event(Event("error.communication", {"to": to, "reason": reason}, self.at))

    def cancel_send(self, id: str) -> None:
        """Cancel the `send` with that id if it is not due yet (SCXML 6.3)."""
        self.timers = tuple(t for t in self.timers if t.kind != "send" or t.id != id)

    def wait(self, seconds: float) -> str:
        """Set the timer of a `wait` in the `do` of the current node, `seconds` from now; return its id."""
        id, length = self._timer_id("w"), nanoseconds(seconds)
        timer = Timer(id, nanoseconds(self.at) + length, length, f"wait.{id}", None, self.node.path, "wait")
        self.timers = (*self.timers, timer)
        return id

    def _timer_id(self, letter: str) -> str:
        self.counters = self.counters._replace(timers=self.counters.timers + 1)
        return f"{letter}{self.counters.timers}"

    def raise_event(self, event: Event) -> None:
        """Append an event to the internal queue (SCXML 4.2)."""
        if not self.internal_queue:
            self.internal_queue = deque()
        self.internal_queue.append(event)
        self.raised += (event,)

    def raise_error(self, reason: str, where: NodePath) -> None:
        """Raise error.execution, unless that place fails again while an error.execution is processed."""
        handling = self.event is not None and self.event.name == "error.execution"
        if not (handling and where in self.failed):
            self.failed |= {where}
            place = ".".join(map(str, where))
            self.raise_event(Event("error.execution", {"reason": reason, "where": place}, self.at))
