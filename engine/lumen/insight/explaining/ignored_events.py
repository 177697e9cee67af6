"""Why an event changed nothing: no active state listens to it, or guards were false, with their values."""

from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

from lumen.expressions import Scope
from lumen.expressions.readings import readings
from lumen.expressions.scope import no_draw
from lumen.insight.explaining.hearing import heard_row, heard_rows
from lumen.language.actions import Expression
from lumen.language.controllers import CONTROLLER_EVENT
from lumen.language.events import Event
from lumen.language.machines import MachineDefinition, StateKind
from lumen.language.shared import SHARED_EVENT
from lumen.statechart.chart import Chart, StateNode
from lumen.statechart.compiled_machine import compiled
from lumen.statechart.nesting import flattened_steps
from lumen.statechart.plans import Configuration
from lumen.statechart.values import Snapshot, Step

_TIMED = ("after.", "at.")
_OWN = (*_TIMED, "done.do.", "done.state.", "done.invoke.", "error.do.", "error.invoke.")
"""The prefixes of events that a behaviour sends itself: `after`, `at`, `onDone` and `onError`."""


class FalseGuard(NamedTuple):
    """A guard that was false, or a row of `hears` whose phrase was found but does not count."""

    state: str
    """The outside name of the state that has the transition."""
    guard: Expression
    """The guard; for a phrase that does not count, the title of the row."""
    values: Mapping[str, Any]
    """The values that the guard read, by their names in it."""
    why: str = ""
    """Why the phrase does not count; empty for a guard."""


class IgnoredEvent(NamedTuple):
    """An event that changed nothing."""

    event: Event
    """The event that had no effect."""
    deaf: tuple[str, ...]
    """The innermost active states that do not listen to the event, although other states of their regions do."""
    refused: tuple[FalseGuard, ...]
    """The guards that were false."""
    unheard: tuple[str, ...] = ()
    """The states with `hears` in which no phrase was found."""


def ignored(machine: MachineDefinition, step: Step) -> IgnoredEvent | None:
    """Return why the event of a step changed nothing; None if it had an effect, or if no state ever listens to it.

    For an event that the behaviour sends itself, such as a timer or the end of a `do`, only false guards are reasons.
    """
    event, parts = step.event, list(flattened_steps(machine, step))
    if event is None or any(part.transitions for _, _, part in parts):
        return None
    for prefix, definition, part in parts:
        for own in (part.event, *part.raised):
            if own and own.name.startswith(_OWN) and (false := tuple(_refused(prefix, definition, part, own))):
                return IgnoredEvent(own, (), false)
    if event.sendid or ".command." in event.name or event.name.startswith((*_OWN, CONTROLLER_EVENT, SHARED_EVENT)):
        return None
    if any(part.raised for _, _, part in parts):
        return None
    deaf: list[str] = []
    refused: list[FalseGuard] = []
    unheard: list[str] = []
    for prefix, definition, part in parts:
        deaf += [prefix + name for name in _deaf(definition, part, event.name)]
        refused += _refused(prefix, definition, part, event)
        unheard += _unheard(prefix, definition, part, event)
    return IgnoredEvent(event, tuple(deaf), tuple(refused), tuple(unheard)) if deaf or refused or unheard else None


def _deaf(machine: MachineDefinition, step: Step, name: str) -> Iterator[str]:
    planner = compiled(machine).planner
    chart, standing = planner.chart, planner.configuration(step.snapshot.configuration)
    for leaf in standing.leaves:
        hears = any(_listens(node, name) for node in (leaf, *leaf.ancestors))
        region = next((n for n in (leaf, *leaf.ancestors) if n.parent and n.parent.kind is StateKind.PARALLEL), None)
        if not hears and any(_listens(node, name) for node in chart.nodes.values() if _within(node, region)):
            yield leaf.name or chart.definition.id


def _within(node: StateNode, region: StateNode | None) -> bool:
    return region is None or node is region or node.lies_below(region)


def _listens(node: StateNode, name: str) -> bool:
    """Return whether a state has a transition for that event; a transition for every event (`*`) does not count."""
    return any(transition.definition.event != "*" and transition.matches(name) for transition in node.transitions)


def _refused(prefix: str, machine: MachineDefinition, step: Step, event: Event) -> Iterator[FalseGuard]:
    planner = compiled(machine).planner
    chart, standing = planner.chart, planner.configuration(step.snapshot.configuration)
    timed = event.name.startswith(_TIMED) and event.sendid
    groups = standing.timed(event.name) if timed else standing.candidates(event.name)
    for transition in dict.fromkeys(groups.all):
        wanted, state = transition.definition, prefix + (transition.source.name or machine.id)
        scope = _scope(chart, transition.source, standing, step.snapshot, event)
        row = heard_row(machine, wanted, scope) if wanted.hears else None
        if row and row.fate != "guard":
            if row.fate != "not found":
                why = "a behaviour that this state invokes listens too" if row.fate == "taken" else row.why
                yield FalseGuard(state, Expression(row.row.title), {}, why)
        elif guard := wanted.guard:
            values = readings(guard.source, scope, guard.shown)
            yield FalseGuard(state, guard, values)


def _unheard(prefix: str, machine: MachineDefinition, step: Step, event: Event) -> Iterator[str]:
    """Yield active states with `hears` in which no phrase was found."""
    planner = compiled(machine).planner
    standing = planner.configuration(step.snapshot.configuration)
    groups = standing.candidates(event.name)
    rows = (t for t in groups.all if t.definition.hears)
    for node in dict.fromkeys(t.source for t in rows):
        scope = _scope(planner.chart, node, standing, step.snapshot, event)
        if all(row.fate == "not found" for row in heard_rows(machine, node.path, scope)):
            yield prefix + (node.name or machine.id)


def _scope(chart: Chart, node: StateNode, standing: Configuration, now: Snapshot, event: Event) -> Scope:
    """Return the scope in which the guard was evaluated; nothing has changed since."""
    machine, seen = chart.definition, {"name": event.name, "data": event.data}
    return Scope(
        now.context, seen, node.view(now.language, now.place), standing.known.__contains__, now.at, now.language,
        machine.phrases, machine.answers, now.epoch, now.timezone, machine.lists, no_draw, machine,
    )  # fmt: skip
