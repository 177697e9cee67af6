"""The transitions that lead to a state, or to an action that says or plays something."""

from collections.abc import Iterator
from typing import NamedTuple

from lumen.insight.explaining.names import PlacedDeed, deeds_in, machines_in, same_text, state_named
from lumen.insight.explaining.words import prefix_of
from lumen.language.actions import SayText
from lumen.language.machines import MachineDefinition, StateKind, Transition
from lumen.statechart.compiled_machine import compiled
from lumen.statechart.history import History
from lumen.statechart.state_sets import StateSets


class Way(NamedTuple):
    """A transition of the behaviour that runs under `owner`, and the action that it leads to; None if a state is
    sought.
    """

    owner: str
    machine: MachineDefinition
    transition: Transition
    deed: PlacedDeed | None = None


def ways(machine: MachineDefinition, what: str) -> list[Way]:
    """Return every transition that leads to `what`; a state has precedence over a motion or a text of that name."""
    if state := state_named(machine, what):
        return list(_into(machine, state))
    found = {id(way.transition): way for deed in deeds(machine, what) for way in _towards(deed)}
    return list(found.values())


def deeds(machine: MachineDefinition, what: str) -> Iterator[PlacedDeed]:
    """Yield the actions that say, play or do `what`."""
    for deed in deeds_in(machine):
        action = deed.action
        if isinstance(action, SayText):
            if any(same_text(what, text.text) for texts in action.texts.values() for text in texts):
                yield deed
        elif what in (
            getattr(action, name) for name in ("motion", "name", "to", "file", "route") if hasattr(action, name)
        ):
            yield deed


def _into(machine: MachineDefinition, state: str) -> Iterator[Way]:
    for owner, inner in machines_in(machine):
        for path, one in inner.states.items():
            if path and prefix_of(owner) + one.name == state:
                yield from (Way(owner, inner, t) for t in entering(inner, path))


def entering(machine: MachineDefinition, path: str) -> Iterator[Transition]:
    """Yield the transitions that enter the state at that path, assuming that no history is remembered."""
    chart = compiled(machine).chart
    nothing: History = {}
    sets = StateSets(chart, nothing)
    for node in chart.nodes.values():
        for transition in node.transitions:
            if transition.targets and chart.nodes[path] in sets.entry_set(sets.domains([transition])):
                yield transition.definition


def _towards(deed: PlacedDeed) -> Iterator[Way]:
    """Yield the transitions after which an action runs."""
    for transition in deed.state.transitions:
        inside = deed.where[: len(transition.where)] == transition.where
        if (not deed.block and inside) or (deed.block == "exit" and transition.targets):
            yield Way(deed.owner, deed.machine, transition, deed)
    if deed.block in ("entry", "do") and deed.state.kind is not StateKind.HISTORY:
        for transition in entering(deed.machine, deed.state.path):
            yield Way(deed.owner, deed.machine, transition, deed)
