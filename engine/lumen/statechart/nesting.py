"""Behaviours within behaviours as they are seen from outside: `quiz/ask` is the state `ask` of what runs as `quiz`."""

from collections.abc import Iterable, Iterator
from itertools import compress
from operator import not_

from lumen.language.machines import MachineDefinition
from lumen.statechart.values import Snapshot, Step

ID_SEPARATOR = "/"
"""Stands between the id of an `invoke` and a state of the behaviour that runs under it."""


def active_names(snapshot: Snapshot) -> frozenset[str]:
    """The names of all active states, those of invoked behaviours included."""
    if not snapshot.invoked:
        return snapshot.configuration
    inner = (
        f"{id}{ID_SEPARATOR}{name}" for id, child in snapshot.invoked.items() for name in active_names(child.snapshot)
    )
    return snapshot.configuration.union(inner)


def innermost_names(machine: MachineDefinition, snapshot: Snapshot) -> Iterator[str]:
    """The names of the active states that have none active within, invoked behaviours' after those of their host."""
    for state in machine.states.values():
        if state.name in snapshot.configuration and not any(
            machine.states[child].name in snapshot.configuration for child in state.children
        ):
            yield state.name
    for id, child in snapshot.invoked.items():
        other = machine.invoked[machine.invoked_behavior(child.state, id)]
        yield from (f"{id}{ID_SEPARATOR}{name}" for name in innermost_names(other, child.snapshot))


def entered_names(step: Step) -> Iterator[str]:
    """The names of all states that a step entered, those of invoked behaviours included."""
    yield from step.entered
    for id, inner in step.invoked:
        yield from (f"{id}{ID_SEPARATOR}{name}" for name in entered_names(inner))


def flattened_steps(
    machine: MachineDefinition, step: Step, prefix: str = ""
) -> "Iterator[tuple[str, MachineDefinition, Step]]":
    """A step and those of the behaviours invoked in it, each with its machine, and `quiz/` before its states' names.

    What an invoked behaviour did is before its host's step where it led to it, else after.
    """
    ends = {t.event.split(".", 2)[2] for t in step.transitions if t.event.startswith(("done.invoke.", "error.invoke."))}
    early = [id in ends and inner.event is not None for id, inner in step.invoked]
    yield from _below(machine, compress(step.invoked, early), prefix)
    yield prefix, machine, step
    yield from _below(machine, compress(step.invoked, map(not_, early)), prefix)


def behavior_of(machine: MachineDefinition, id: str, step: Step) -> str:
    """The behaviour of which a step is, among those that the machine invokes under that id."""
    behaviors = [invoke.behavior for state in machine.states.values() for invoke in state.invoke if invoke.id == id]
    names = {*step.entered, *step.exited, *step.snapshot.configuration}
    known = {b: {state.name for state in machine.invoked[b].states.values()} for b in behaviors}
    return next((b for b in behaviors if names <= known[b]), behaviors[0])


def resolutions(machine: MachineDefinition, name: str) -> Iterator[tuple[MachineDefinition, str]]:
    """The machines that a name may be about, and the name there: `quiz/ask` is `ask` of what is invoked as `quiz`."""
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
