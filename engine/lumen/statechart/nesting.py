"""State names across invoked behaviours: `quiz/ask` is the state `ask` of the behaviour invoked as `quiz`."""

from collections.abc import Iterable, Iterator
from itertools import compress
from operator import not_

from lumen.language.machines import MachineDefinition
from lumen.statechart.values import Snapshot, Step

ID_SEPARATOR = "/"
"""Separates the id of an `invoke` from the name of a state in the invoked behaviour."""


def active_names(snapshot: Snapshot) -> frozenset[str]:
    """Return the names of all active states, including those of invoked behaviours."""
    if not snapshot.invoked:
        return snapshot.configuration
    inner = (
        f"{id}{ID_SEPARATOR}{name}" for id, child in snapshot.invoked.items() for name in active_names(child.snapshot)
    )
    return snapshot.configuration.union(inner)


def innermost_names(machine: MachineDefinition, snapshot: Snapshot) -> Iterator[str]:
    """Yield the names of active states without active children; invoked behaviours follow their host."""
    for state in machine.states.values():
        if state.name in snapshot.configuration and not any(
            machine.states[child].name in snapshot.configuration for child in state.children
        ):
            yield state.name
    for id, child in snapshot.invoked.items():
        other = machine.invoked[machine.invoked_behavior(child.state, id)]
        yield from (f"{id}{ID_SEPARATOR}{name}" for name in innermost_names(other, child.snapshot))


def entered_names(step: Step) -> Iterator[str]:
    """Yield the names of all states that a step entered, including those of invoked behaviours."""
    yield from step.entered
    for id, inner in step.invoked:
        yield from (f"{id}{ID_SEPARATOR}{name}" for name in entered_names(inner))


def flattened_steps(
    machine: MachineDefinition, step: Step, prefix: str = ""
) -> "Iterator[tuple[str, MachineDefinition, Step]]":
    """Yield a step and those of the behaviours invoked in it, each with the prefix of its state names and its machine.

    The step of an invoked behaviour comes before its host's step if its end caused a transition of the host, else
    after.
    """
    ends = {t.event.split(".", 2)[2] for t in step.transitions if t.event.startswith(("done.invoke.", "error.invoke."))}
    early = [id in ends and inner.event is not None for id, inner in step.invoked]
    yield from _below(machine, compress(step.invoked, early), prefix)
    yield prefix, machine, step
    yield from _below(machine, compress(step.invoked, map(not_, early)), prefix)


def behavior_of(machine: MachineDefinition, id: str, step: Step) -> str:
    """Return the name of the behaviour that made a step, among those that the machine invokes under that id."""
    behaviors = [invoke.behavior for state in machine.states.values() for invoke in state.invoke if invoke.id == id]
    names = {*step.entered, *step.exited, *step.snapshot.configuration}
    known = {b: {state.name for state in machine.invoked[b].states.values()} for b in behaviors}
    return next((b for b in behaviors if names <= known[b]), behaviors[0])


def resolutions(machine: MachineDefinition, name: str) -> Iterator[tuple[MachineDefinition, str]]:
    """Yield each machine in which a name may occur, and the name there.

    `quiz/ask` is `ask` in the behaviour invoked as `quiz`.
    """
    invokes = {(invoke.id, invoke.behavior) for state in machine.states.values() for invoke in state.invoke}
    for id, behavior in sorted(invokes):
        if name.startswith(id + ID_SEPARATOR) and behavior in machine.invoked:
            yield from resolutions(machine.invoked[behavior], name.removeprefix(id + ID_SEPARATOR))
    yield machine, name


def _below(
    machine: MachineDefinition, steps: "Iterable[tuple[str, Step]]", prefix: str
) -> "Iterator[tuple[str, MachineDefinition, Step]]":
    for id, step in steps:
        yield from flattened_steps(machine.invoked[behavior_of(machine, id, step)], step, f"{prefix}{id}{ID_SEPARATOR}")
