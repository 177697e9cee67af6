"""Enters a state at a person's request, as a transition from the current configuration would."""

from collections.abc import Iterator

from lumen.errors import UsageError
from lumen.language.diagnostics import did_you_mean
from lumen.language.events import Event
from lumen.language.machines import MachineDefinition, StateKind, Transition
from lumen.statechart.chart import Chart, CompiledTransition, StateNode
from lumen.statechart.compiled_machine import compiled
from lumen.statechart.invocations import open_context
from lumen.statechart.macrostep import complete
from lumen.statechart.microstep import microstep
from lumen.statechart.nesting import ID_SEPARATOR
from lumen.statechart.plans import Configuration
from lumen.statechart.values import Snapshot, Step


def entered_directly(machine: MachineDefinition, snapshot: Snapshot, name: str, event: Event) -> Step:
    """Return the step that enters a state at once, regardless of guards; `event` gives the requester and the time.

    Only states that exclude it are left: parallel regions stay as they are. An active state is left and entered again.
    `name` is an alias, a path, or the unique end of a path. Raises UsageError if there is no such state, if it belongs
    to an invoked behaviour, or if the machine has ended.
    """
    program = compiled(machine)
    target = _named(machine, program.chart, name)
    context = open_context(program, snapshot, event, max(snapshot.at, event.at))
    if context.configuration.finished:
        raise UsageError(f"`{machine.id}` has ended: no state can be entered now")
    source, targets = _way(target, context.configuration)
    where = tuple(node.path for node in targets)
    transition = CompiledTransition(Transition(source.path, event.name, where), source, targets)
    microstep(context, program.planner.plan(context.configuration, transition.alone, context.history))
    return complete(context)


def _way(target: StateNode, standing: Configuration) -> tuple[StateNode, tuple[StateNode, ...]]:
    """Return the source and targets of a transition from the innermost active ancestor, which leaves nothing else."""
    assert target.parent is not None  # only the document has no parent, and it has no name
    if target.parent.kind is StateKind.PARALLEL and target in standing.nodes and target.initial:
        return target, target.initial
    return next(node for node in target.ancestors if node in standing.nodes), (target,)


def _named(machine: MachineDefinition, chart: Chart, name: str) -> StateNode:
    nodes = [node for node in chart.nodes.values() if node.path]
    found = [node for node in nodes if name in (node.name, node.path)]
    found = found or [node for node in nodes if node.path.rpartition(".")[2] == name]
    if len(found) == 1:
        return found[0]
    if found:
        raise UsageError(f"`{name}` is ambiguous: choose one of {', '.join(f'`{node.path}`' for node in found)}")
    if inside := next(_invoked(machine, name), ""):
        raise UsageError(inside)
    raise UsageError(f"there is no state `{name}`: {did_you_mean(name, _names(nodes), 'there are')}")


def _invoked(machine: MachineDefinition, name: str) -> Iterator[str]:
    """Yield why a state of that name can't be entered: it belongs to a behaviour that the machine invokes."""
    for state in machine.states.values():
        for invoke in state.invoke:
            inner, end = machine.invoked.get(invoke.behavior), name.removeprefix(f"{invoke.id}{ID_SEPARATOR}")
            paths = [(s.name, s.path, s.path.rpartition(".")[2]) for s in inner.states.values()] if inner else []
            if any(end in names for names in paths):
                where = f"a state of `{invoke.behavior}`, which `{state.name}` invokes"
                yield f"`{end}` is {where}, so it can't be entered directly: enter `{state.name}`, which starts it"


def _names(nodes: list[StateNode]) -> Iterator[str]:
    for node in nodes:
        yield node.name
        if node.name == node.path:
            yield node.path.rpartition(".")[2]
