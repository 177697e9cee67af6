"""The states that a microstep exits and enters, in order, and the names that are active meanwhile."""

from collections.abc import Container, Mapping, Sequence
from collections.abc import Set as AbstractSet
from typing import NamedTuple

from lumen.language.machines import StateKind
from lumen.statechart.chart import StateNode
from lumen.statechart.state_sets import in_final


class StateChange(NamedTuple):
    """One state to exit or enter."""

    node: StateNode
    active: Container[str]
    """The names for which `In` is true while the state's actions run."""
    done: tuple[StateNode, ...] = ()
    """The ancestors that its entry finishes, the nearest first."""


class ActiveView:
    """The active names during a microstep: those `before` it, corrected by the states exited or entered so far.

    It stores no set of its own, because a microstep through a thousand regions needs a thousand views.
    """

    __slots__ = ("before", "entering", "order", "place")

    def __init__(self, before: frozenset[str], order: Mapping[str, int], place: int, entering: bool) -> None:
        self.before, self.order, self.place, self.entering = before, order, place, entering

    def __contains__(self, name: object) -> bool:
        place = self.order.get(str(name))
        if place is None:
            return name in self.before
        return place <= self.place if self.entering else place >= self.place


def exits(left: AbstractSet[StateNode], active: AbstractSet[StateNode]) -> tuple[StateChange, ...]:
    """Return the states to exit, in exit order, without those that have nothing to execute (`exitStates`)."""
    way = exit_order(left)
    before, order = names_of(active), _order(way)
    return tuple(
        StateChange(node, ActiveView(before, order, i, False)) for i, node in enumerate(way) if node.exit or node.busy
    )


def entries(entered: AbstractSet[StateNode], staying: AbstractSet[StateNode]) -> tuple[StateChange, ...]:
    """Return the states to enter, in entry order, without those that have nothing to execute (`enterStates`)."""
    way = entry_order(entered)
    active, before, order = set(staying), names_of(staying), _order(way)
    changes = []
    for place, node in enumerate(way):
        active.add(node)
        done = _done(node, active)
        if node.entry or node.busy or done:
            changes.append(StateChange(node, ActiveView(before, order, place, True), done))
    return tuple(changes)


def exit_order(nodes: AbstractSet[StateNode]) -> list[StateNode]:
    """Return children before their parents, the last in the document first (`exitOrder`)."""
    return sorted(nodes, key=lambda node: -node.index)


def entry_order(nodes: AbstractSet[StateNode]) -> list[StateNode]:
    """Return parents before their children, in document order (`entryOrder`)."""
    return sorted(nodes, key=lambda node: node.index)


def names_of(nodes: AbstractSet[StateNode]) -> frozenset[str]:
    """Return all names for which `In()` is true: paths and aliases."""
    return frozenset(name for node in nodes for name in (node.path, node.name) if name)


def _order(way: Sequence[StateNode]) -> dict[str, int]:
    return {name: place for place, node in enumerate(way) for name in (node.path, node.name) if name}


def _done(node: StateNode, active: AbstractSet[StateNode]) -> tuple[StateNode, ...]:
    """Return the ancestors that the entry of `node` finishes: a compound parent, then the parallel states around it."""
    above = node.parent
    if node.kind is not StateKind.FINAL or above is None:
        return ()
    found = []
    if above.kind is StateKind.COMPOUND:
        found.append(above)
        above = above.parent
    while above and above.kind is StateKind.PARALLEL and in_final(above, active):
        found.append(above)
        above = above.parent
    return tuple(found)
