"""Everything that can happen next to a behaviour: events, ends of timers, and the robot's answers."""

from collections.abc import Iterator, Mapping
from enum import StrEnum
from itertools import islice
from typing import Any, NamedTuple

from lumen.errors import ExpressionError
from lumen.expressions import ExpressionNode, Scope, compile_expression, names, unparse
from lumen.expressions.function_table import clock_functions
from lumen.expressions.tree import Binary, FunctionCall, children
from lumen.insight.exploration.expression_uses import ExpressionUse, of_block, of_transition
from lumen.insight.exploration.samples import FieldPath, samples
from lumen.language.added_verbs import usual_result
from lumen.language.commands import BodyCommand, GoTo
from lumen.language.controllers import CONTROLLER_EVENT
from lumen.language.events import ARRIVED, Event
from lumen.language.machines import Hears, MachineDefinition, Transition, is_within
from lumen.statechart import Snapshot, Timer
from lumen.statechart.command_ids import outer_id
from lumen.statechart.compiled_machine import CompiledMachine, compiled
from lumen.statechart.values import awaited
from lumen.talk.hearing import hearing_of, said_in
from lumen.talk.sample_sentences import of_row

FAILURE_REASON = "a simulated failure"

COMPARISONS = frozenset(("==", "!=", "<", "<=", ">", ">=", "in"))


class StimulusKind(StrEnum):
    """The kind of stimulus: an event from outside, the end of a timer, the end of a command, or its failure."""

    EVENT = "event"
    TIME = "time"
    DONE = "done"
    FAILED = "failed"


STIMULUS_COSTS: Mapping[StimulusKind, int] = {
    StimulusKind.DONE: 0,
    StimulusKind.EVENT: 2,
    StimulusKind.TIME: 2,
    StimulusKind.FAILED: 7,
}
"""The cost of a stimulus on the path to the shortest story: a command that the robot completes costs nothing."""

OVERTAKING_COST = 5
"""The extra cost if a timer ends during a command, or before a timer that is due earlier."""

MAX_SAID = 20
"""The maximum number of sentences that are tried for a row of `hears`."""


class Stimulus(NamedTuple):
    """A stimulus: an event from outside, the end of a timer, or the robot's answer to a command."""

    kind: StimulusKind
    """The kind of stimulus."""
    event: Event
    """The event that the behaviour processes."""
    waited: float = 0.0
    """The time until the stimulus happens [s]."""
    command: BodyCommand | None = None
    """The command that is answered; None for other kinds."""
    pending: tuple[BodyCommand, ...] = ()
    """The commands that the robot is performing at that time."""
    overtaking: bool = False
    """Whether a timer ends before one that is due earlier."""

    @property
    def cost(self) -> int:
        """The stimulus's cost on the path to a story."""
        return STIMULUS_COSTS[self.kind] + OVERTAKING_COST * (bool(self.pending) + self.overtaking)


class HeardTransition(NamedTuple):
    """A transition that an event can select, with its machine and the machine's context."""

    machine: MachineDefinition
    transition: Transition
    context: Mapping[str, Any]


class StimulusFinder:
    """Finds the stimuli of snapshots; `events` are those from outside, each with the JSON Schema of its data."""

    def __init__(self, machine: MachineDefinition, events: Mapping[str, Any]) -> None:
        self._machine, self._events = machine, events
        self._compiled = compiled(machine)
        self._known: dict[tuple[Any, ...], tuple[Any, ...]] = {}
        self._keys: dict[tuple[Any, ...], tuple[tuple[str, ...], ...]] = {}

    def of(self, snapshot: Snapshot, commands: Mapping[str, BodyCommand]) -> Iterator[Stimulus]:
        """Yield the stimuli of a snapshot; `commands` are those started so far, by id."""
        commanded = [id for id in _awaited(snapshot) if not _is_wait(id)]
        pending = tuple(commands[id] for id in commanded if id in commands)
        for id in commanded:
            command = commands.get(id)
            event = _arrival(command, snapshot) or Event(f"done.command.{id}", usual_result(command), snapshot.at)
            yield Stimulus(StimulusKind.DONE, event, 0.0, command)
        for timer in _next(snapshot):
            at = max(timer.due, snapshot.at)
            event = Event(timer.event, timer.data, at, timer.id)
            unanswered = () if _is_wait(timer.id) else pending
            overtaking = any(t.due_ns < timer.due_ns for t in snapshot.timers)
            yield Stimulus(StimulusKind.TIME, event, at - snapshot.at, None, unanswered, overtaking)
        for name in self._events:
            yield from (
                Stimulus(StimulusKind.EVENT, Event(name, data, snapshot.at)) for data in self._data(name, snapshot)
            )
        for id in commanded:
            event = Event(f"error.command.{id}", {"reason": FAILURE_REASON}, snapshot.at)
            yield Stimulus(StimulusKind.FAILED, event, 0.0, commands.get(id))

    def _data(self, name: str, snapshot: Snapshot) -> tuple[Any, ...]:
        """Return samples of an event's data: one for each case that the waiting transitions distinguish."""
        if name.startswith(CONTROLLER_EVENT):
            return tuple(_extremes(self._events[name]))
        heard = tuple(_heard(self._compiled, snapshot, name))
        if not heard:
            return ()
        entries = (repr(context[key]["entry"]) for machine, _, context in heard for key in loop_keys(machine))
        transitions = (name, *(id(transition) for _, transition, _ in heard))
        if transitions not in self._keys:
            self._keys[transitions] = tuple(map(_compared_keys, heard))
        compared = zip(heard, self._keys[transitions], strict=True)
        known = (
            *transitions,
            *entries,
            *(repr(one.context.get(key)) for one, keys in compared for key in keys),
        )
        if known not in self._known:
            self._known[known] = tuple(self._sorts(name, heard))
        return self._known[known]

    def _sorts(self, name: str, heard: tuple[HeardTransition, ...]) -> Iterator[Any]:
        trees = [(one, use.tree) for one in heard for use in _uses(one)]
        atoms = [
            (one, unparse(node))
            for one, tree in trees
            for part in (_known_of_events(tree, loop_keys(one.machine)), _compared(tree, loop_keys(one.machine)))
            for node in part
        ]
        seen = set()
        for machine in dict.fromkeys(id(one.machine) for one in heard):
            about = [tree for owner, tree in trees if id(owner.machine) == machine]
            owner = next(one for one in heard if id(one.machine) == machine)
            more: dict[FieldPath, list[str]] = {("result",): texts} if (texts := list(_said(heard))) else {}
            for data in samples(owner.machine, self._events[name], about, owner.context, more):
                sort: tuple[Any, ...] = tuple(_sort(one, source, name, data) for one, source in atoms)
                if more:
                    sort += tuple(_orders(heard, name, data))
                if sort not in seen:
                    seen.add(sort)
                    yield data


def _uses(heard: HeardTransition) -> Iterator[ExpressionUse]:
    """Yield the expressions of a transition and of the entry of its targets: both see the same event."""
    yield from of_transition(heard.transition)
    for target in heard.transition.targets:
        yield from of_block(heard.machine.states[target].entry)


def loop_keys(machine: MachineDefinition) -> frozenset[str]:
    """Return the context keys for the entries of `for`; they are cached on the definition."""
    found: frozenset[str] | None = machine.__dict__.get("_loop_keys")
    if found is None:
        found = frozenset(state.for_each.key for state in machine.states.values() if state.for_each)
        object.__setattr__(machine, "_loop_keys", found)  # frozen, but all holders of the definition share it
    return found


def _arrival(command: BodyCommand | None, snapshot: Snapshot) -> Event | None:
    """Return the arrival event that precedes the end of a walk to another place; None for other commands."""
    if not isinstance(command, GoTo) or command.to == snapshot.place:
        return None
    return Event(ARRIVED, {"place": command.to, "doubt": 0.0}, snapshot.at)


def _heard(machine: CompiledMachine, snapshot: Snapshot, name: str) -> Iterator[HeardTransition]:
    """Yield the transitions that an event of that name can select in this behaviour or invoked ones."""
    for transition in machine.planner.configuration(snapshot.configuration).candidates(name).all:
        yield HeardTransition(machine.chart.definition, transition.definition, snapshot.context)
    for id, child in snapshot.invoked.items():
        behavior = machine.chart.definition.invoked_behavior(child.state, id)
        yield from _heard(machine.invoked[behavior], child.snapshot, name)


def _said(heard: tuple[HeardTransition, ...]) -> Iterator[str]:
    """Yield texts for each row of `hears`: one text for each of its names, and one more.

    If there are texts for which the row is the best of its state, only those are used: "no no problems" is not an
    example of `not fine`.
    """
    for machine, transition, context in heard:
        if row := transition.hears:
            said = list(islice(of_row(machine, row, context), MAX_SAID))
            best = [text for text in said if _is_best(machine, row, text, context)]
            yield from (best or said)[: 1 + len(row.names)]


def _is_best(machine: MachineDefinition, row: Hears, text: str, context: Mapping[str, Any]) -> bool:
    """Return whether this row is the best for a text among those of its state."""
    first, late = hearing_of(machine).order(row.number, text, context)
    return next((one.number for one in (*first, *late)), None) == row.number


def _orders(heard: tuple[HeardTransition, ...], name: str, data: Any) -> Iterator[Any]:
    """Yield the order of the rows of each state for a text."""
    text = said_in({"name": name, "data": data})
    for machine, transition, context in heard:
        if transition.hears:
            order = hearing_of(machine).order(transition.hears.number, text, context)
            yield tuple(one.number for one in order.first), tuple(one.number for one in order.late)


def _extremes(schema: Mapping[str, Any]) -> Iterator[Any]:
    """Yield the minimum and the maximum data that a controller can send."""
    for end in ("minimum", "maximum"):
        yield {key: value[end] for key, value in schema["properties"].items() if end in value}


def _known_of_events(tree: ExpressionNode, loops: frozenset[str]) -> Iterator[ExpressionNode]:
    """Yield the largest parts of an expression that depend only on the event's data and on entries of `for`."""
    speaks = names(tree)
    alone = speaks.context <= loops and not speaks.functions & {"In", *clock_functions()}
    if alone and "event" in unparse(tree):
        yield tree
    elif not alone:
        for child in children(tree):
            yield from _known_of_events(child, loops)


def _compared(tree: ExpressionNode, loops: frozenset[str]) -> Iterator[ExpressionNode]:
    """Yield the smallest parts of an expression that need the event's data and context other than `for` entries."""
    within = [node for child in children(tree) for node in _compared(child, loops)]
    yield from within
    compares = tree.sign in COMPARISONS if isinstance(tree, Binary) else isinstance(tree, FunctionCall)
    if compares and not within:
        speaks = names(tree)
        if speaks.context - loops and "event" in unparse(tree) and not speaks.functions & {"In", *clock_functions()}:
            yield tree


def _compared_keys(heard: HeardTransition) -> tuple[str, ...]:
    """Return the context keys that a transition compares with the event's data, sorted."""
    loops = loop_keys(heard.machine)
    found = (names(node).context for use in _uses(heard) for node in _compared(use.tree, loops))
    return tuple(sorted(frozenset().union(*found)))


def _sort(heard: HeardTransition, source: str, name: str, data: Any) -> str:
    """Return the value of a part of an expression for an event if it is short, else `something`; `fails` for errors."""
    machine, _, context = heard
    scope = Scope(context, {"name": name, "data": data}, phrases=machine.phrases, answers=machine.answers)
    scope = scope._replace(lists=machine.lists, machine=machine)
    try:
        value = compile_expression(source)(scope)
    except ExpressionError:
        return "fails"
    return repr(value) if isinstance(value, bool | int | float) or not value else "something"


def _next(snapshot: Snapshot) -> Iterator[Timer]:
    """Yield the timers that can end next.

    It is unknown how long ago an unrelated state was entered; but among the timers of a state and the states around it,
    a shorter delay ends before a longer one.
    """
    for timer in snapshot.timers:
        around = [t for t in snapshot.timers if t.kind == "after" and is_within(timer.state, t.state)]
        if timer.kind == "send" or not any(t.delay_ns < timer.delay_ns for t in around):
            yield timer
    for owner, child in snapshot.invoked.items():
        yield from (timer._replace(id=outer_id(timer.id, owner)) for timer in _next(child.snapshot))


def _awaited(snapshot: Snapshot) -> Iterator[str]:
    """Yield the ids that a `do` waits for, as seen from outside."""
    for position in snapshot.doing.values():
        yield from awaited(position)
    for owner, child in snapshot.invoked.items():
        yield from (outer_id(id, owner) for id in _awaited(child.snapshot))


def _is_wait(id: str) -> bool:
    """Return whether an id belongs to a `wait`, which ends with its timer."""
    return id.startswith("w")
