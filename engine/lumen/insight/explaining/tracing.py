"""Takes a recorded step again, and records its decisions and actions; nothing is traced while an exhibition runs."""

from dataclasses import dataclass, field
from typing import Any, NamedTuple, Self

from lumen.expressions import Scope
from lumen.expressions.scope import no_draw
from lumen.insight.explaining.traced_machine import traced
from lumen.language.commands import BodyCommand, Command
from lumen.language.diagnostics import NodePath
from lumen.language.events import Event
from lumen.language.machines import MachineDefinition, Transition
from lumen.statechart.chart import StateNode
from lumen.statechart.command_ids import answer_of, outer_command, outer_id
from lumen.statechart.compiled_machine import CompiledMachine
from lumen.statechart.execution_context import ExecutionContext, InvocationHandler
from lumen.statechart.external_events import process
from lumen.statechart.invocations import Invocations
from lumen.statechart.macrostep import enter_machine
from lumen.statechart.plans import NO_CANDIDATES, Candidates, Configuration, Group
from lumen.statechart.values import Snapshot, Step, Timer


class Moment(NamedTuple):
    """A decision about which transitions are taken."""

    owner: str
    """The ids of the invokes under which the behaviour runs, as in `hint@quiz`; empty for the outermost."""
    machine: CompiledMachine
    """The compiled machine that decided."""
    event: Event | None
    """The event that was processed; None if there was none."""
    eventless: bool
    """Whether only transitions without an event were considered."""
    configuration: Configuration
    """The active states."""
    scope: Scope
    """The scope of the guards."""
    place: str
    """The robot's place in the hall."""

    def scope_of(self, node: StateNode) -> Scope:
        """Return the scope in which the expressions of the state `node` were evaluated."""
        return self.scope._replace(state=node.view(self.scope.language, self.place))

    @property
    def candidates(self) -> Candidates:
        """The transitions that were considered, innermost first for each active atomic state; `later` has late rows."""
        if self.eventless or self.event is None:
            return self.configuration.eventless
        if timed := self.configuration.timed(self.event.name):
            return timed if self.event.sendid else NO_CANDIDATES
        return self.configuration.candidates(self.event.name)

    @property
    def groups(self) -> tuple[Group, ...]:
        """The candidates of each active atomic state in the order in which they are tried, late ones last."""
        chosen = self.candidates
        passes = zip(chosen, *chosen.later, strict=True)
        return tuple(tuple(dict.fromkeys(t for group in groups for t in group)) for groups in passes)


@dataclass(eq=False, slots=True)
class TracedMicrostep:
    """A microstep and the decision that led to it; the first microstep of a machine has no transitions."""

    moment: Moment
    transitions: tuple[Transition, ...]
    exited: tuple[str, ...] = ()
    """The names of the states left."""
    entered: tuple[str, ...] = ()
    """The names of the states entered."""


class Deed(NamedTuple):
    """A command, an event or a timer that an action caused, or that arose by itself."""

    owner: str
    """The ids under which the behaviour runs; empty for the outermost."""
    machine: MachineDefinition
    """The machine that contains the action."""
    what: Command | Event | str
    """A command, an event that was raised, or the id of a `send`."""
    where: NodePath
    """The path of the action in the machine's document; empty if no action caused the deed."""
    state: str
    """The path of the state whose `entry`, `do`, `exit` or transitions contain the action."""
    microstep: TracedMicrostep | None
    """The last microstep before the deed in this step; None if there was none."""

    @property
    def block(self) -> str:
        """The block that contains the action: `entry`, `do` or `exit`; empty for the actions of a transition."""
        key = self.where[len(self.machine.states[self.state].where) :][:1]
        return str(key[0]) if key and key[0] in ("entry", "do", "exit") else ""


@dataclass(slots=True)
class Trace:
    """The record of a step: its decisions, microsteps and deeds, each in order."""

    moments: list[Moment] = field(default_factory=list)
    microsteps: list[TracedMicrostep] = field(default_factory=list)
    deeds: list[Deed] = field(default_factory=list)
    step: Step | None = None
    """The step that was taken; None until it is complete."""

    def entering(self, owner: str, state: str, until: TracedMicrostep | None = None) -> TracedMicrostep | None:
        """Return the last microstep up to `until` that entered the state of that name; None if none did."""
        steps = self.microsteps[: self.microsteps.index(until) + 1] if until else self.microsteps
        found = (one for one in reversed(steps) if one.moment.owner == owner and state in one.entered)
        return next(found, None)


class TracedContext(ExecutionContext):
    """A context that records what happens in it; `acting` is the path of the action that runs."""

    trace: Trace | None = None
    owner = ""
    acting: NodePath = ()
    pending = False
    """Whether an event has come and has not been decided yet."""
    last: TracedMicrostep | None = None
    timers_before: tuple[Timer, ...] = ()

    def begin(self, trace: Trace, owner: str) -> Self:
        """Start recording into `trace`, and return the context."""
        self.owner, self.pending, self.timers_before = owner, self.trigger is not None, self.timers
        self.trace = trace
        return self

    def take_internal(self) -> Event:
        """Return the next internal event, and record the decision on it."""
        self._settle()
        event = super().take_internal()
        self._decide(eventless=False)
        return event

    def leave(self, transitions: tuple[Transition, ...], exited: tuple[str, ...], entered: tuple[str, ...]) -> None:
        """Record the transitions taken and the states left and entered."""
        self._settle(transitions)
        if self.last:
            self.last.exited += exited
            self.last.entered += entered
        super().leave(transitions, exited, entered)

    def reach(self, target: Configuration) -> None:
        """Enter the target configuration, and record the decision without an event that follows."""
        super().reach(target)
        self._decide(eventless=True)

    def _settle(self, taken: tuple[Transition, ...] | None = None) -> None:
        """Record the open decision about the trigger, and the transitions that were taken; None if there were none."""
        assert self.trace is not None
        if self.pending:
            self.pending = False
            if _is_heard(self.trigger, self.timers_before):
                self._decide(eventless=False)
            if taken is None:
                self._decide(eventless=True)
        if taken is not None:
            if not self.trace.moments or self.trace.moments[-1].owner != self.owner or not self._fits(taken):
                self._decide(eventless=bool(taken) and not taken[0].event)
            self.last = TracedMicrostep(self.trace.moments[-1], taken)
            self.trace.microsteps.append(self.last)

    def _fits(self, taken: tuple[Transition, ...]) -> bool:
        assert self.trace is not None
        return not taken or self.trace.moments[-1].eventless == (not taken[0].event)

    def _decide(self, *, eventless: bool) -> None:
        assert self.trace is not None
        self.event_data, self.cached_scope = None, None
        scope = self.scope()._replace(configuration=self.configuration.known.__contains__, draw=no_draw)
        moment = Moment(self.owner, self.machine, self.event, eventless, self.configuration, scope, self.place)
        self.trace.moments.append(moment)

    def within(
        self, id: str, machine: CompiledMachine, snapshot: Snapshot, event: Event | None, invocations: InvocationHandler
    ) -> Self:
        """Return the context of an invoked behaviour, which records into the same trace."""
        assert self.trace is not None
        owner = outer_id(id, self.owner) if self.owner else id
        return super().within(id, machine, snapshot, event, invocations).begin(self.trace, owner)

    def step(self) -> Step:
        """Record the last decision, and return the step."""
        self._settle()
        return super().step()

    def emit(self, command: Command) -> None:
        """Issue a command, and record it as a deed."""
        super().emit(command)
        self._note(outer_command(command, self.owner) if self.owner else command)

    def start(self, command: BodyCommand, *, awaited: bool = False) -> str:
        """Start a command and return its id; after an `awaited` command, no action counts as running."""
        id = super().start(command, awaited=awaited)
        if awaited:
            self.acting = ()
        return id

    def raise_event(self, event: Event) -> None:
        """Raise an internal event, and record it as a deed."""
        super().raise_event(event)
        self._note(event)

    def send(self, id: str, delay: float, event: str, data: Any, to: str) -> None:
        """Send an event, and record its id as a deed if it waits for a timer."""
        before = len(self.timers)
        super().send(id, delay, event, data, to)
        if len(self.timers) > before:
            self._note(self.timers[-1].id)

    def hand_over(self, to: str, event: Event) -> None:
        """Pass an event to another behaviour, and record it as a deed."""
        super().hand_over(to, event)
        self._note(event)

    def _note(self, what: Command | Event | str) -> None:
        assert self.trace is not None
        deed = Deed(self.owner, self.machine.chart.definition, what, self.acting, self.node.path, self.last)
        self.trace.deeds.append(deed)


def retaken(machine: MachineDefinition, before: Snapshot, event: Event | None) -> Trace:
    """Return the trace of the step from `before` by an event; None means the first step, as in `initial`.

    Raises LumenError if the step can't be taken.
    """
    program, trace = traced(machine), Trace()
    at = before.at if event is None else max(before.at, event.at)
    context = TracedContext.of(program, before, event, at, Invocations(before.invoked)).begin(trace, "")
    trace.step = enter_machine(context) if event is None else process(context, event)
    return trace


def _is_heard(event: Event | None, timers: tuple[Timer, ...]) -> bool:
    """Return whether the trigger can select transitions; the answer to a command or the end of a `wait` can't."""
    if event is None or (not event.sendid and answer_of(event)):
        return False
    ended = [t for t in timers if (t.id, t.event) == (event.sendid, event.name)]
    return not event.sendid or any(t.kind != "wait" and not t.to for t in ended)
