"""Why an event changed nothing: which states did not listen, or which guards were false, and with what values."""

from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

from lumen.interpreters.expressions import Scope
from lumen.interpreters.expressions.readings import readings
from lumen.interpreters.expressions.scope import no_draw
from lumen.interpreters.statechart.chart import Chart, StateNode
from lumen.interpreters.statechart.compiled_machine import compiled
from lumen.interpreters.statechart.nesting import flattened_steps
from lumen.interpreters.statechart.plans import Configuration
from lumen.interpreters.statechart.values import Step
from lumen.language.actions import Expression
from lumen.language.controllers import CONTROLLER_EVENT
from lumen.language.events import Event
from lumen.language.machines import MachineDefinition, StateKind


class FalseGuard(NamedTuple):
    """A guard of a transition of `state` that was false, and the values that it looked at, by how they are written."""

    state: str
    guard: Expression
    values: Mapping[str, Any]


class IgnoredEvent(NamedTuple):
    """An event that changed nothing.

    `deaf` are the innermost states of those regions that listen to it, but not where they are now; `refused` the
    guards that were false.
    """

    event: Event
    deaf: tuple[str, ...]
    refused: tuple[FalseGuard, ...]


def ignored(machine: MachineDefinition, step: Step) -> IgnoredEvent | None:
    """Why the event of a step changed nothing; None where it did, or where nothing here ever listens to it.

    Timers and the robot's answers are not asked about: nobody sent them.
    """
    event = step.event
    if event is None or event.sendid or step.transitions or ".command." in event.name:
        return None
    if event.name.startswith(CONTROLLER_EVENT):
        return None
    parts = list(flattened_steps(machine, step))
    if any(part.transitions or part.raised for _, _, part in parts):
        return None
    deaf: list[str] = []
    refused: list[FalseGuard] = []
    for prefix, definition, part in parts:
        planner = compiled(definition).planner
        standing = planner.configuration(part.snapshot.configuration)
        deaf += [prefix + name for name in _deaf(planner.chart, standing, event.name)]
        refused += [guard._replace(state=prefix + guard.state) for guard in _refused(planner.chart, standing, part)]
    return IgnoredEvent(event, tuple(deaf), tuple(refused)) if deaf or refused else None


def _deaf(chart: Chart, standing: Configuration, name: str) -> Iterator[str]:
    for leaf in standing.leaves:
        hears = any(_listens(node, name) for node in (leaf, *leaf.ancestors))
        region = next((n for n in (leaf, *leaf.ancestors) if n.parent and n.parent.kind is StateKind.PARALLEL), None)
        if not hears and any(_listens(node, name) for node in chart.nodes.values() if _within(node, region)):
            yield leaf.name or chart.definition.id


def _within(node: StateNode, region: StateNode | None) -> bool:
    return region is None or node is region or node.lies_below(region)


def _listens(node: StateNode, name: str) -> bool:
    """Whether it has a transition for that event; one that takes any event does not count."""
    return any(transition.definition.event != "*" and transition.matches(name) for transition in node.transitions)


def _refused(chart: Chart, standing: Configuration, step: Step) -> Iterator[FalseGuard]:
    assert step.event is not None  # the caller has looked
    transitions = dict.fromkeys(t for group in standing.candidates(step.event.name) for t in group)
    for transition in transitions:
        if guard := transition.definition.guard:
            scope = _scope(chart, transition.source, standing, step)
            yield FalseGuard(
                transition.source.name or chart.definition.id, guard, readings(guard.source, scope, guard.shown)
            )


def _scope(chart: Chart, node: StateNode, standing: Configuration, step: Step) -> Scope:
    """What the guard saw: nothing has changed since."""
    now, event, machine = step.snapshot, step.event, chart.definition
    seen = {"name": event.name, "data": event.data} if event else None
    return Scope(
        now.context, seen, node.view(now.language, now.place), standing.known.__contains__, now.at, now.language,
        machine.phrases, machine.answers, now.epoch, now.timezone, machine.lists, no_draw,
    )  # fmt: skip
