"""The memory of history states (SCXML 3.10): paths of states, by the path of the history state."""

from collections.abc import Mapping
from collections.abc import Set as AbstractSet

from lumen.language.machines import StateKind
from lumen.statechart.chart import StateNode

History = Mapping[str, tuple[str, ...]]


def recorded(active: AbstractSet[StateNode], left: AbstractSet[StateNode]) -> dict[str, tuple[str, ...]]:
    """Return the new memory of all history states whose parents are left (`historyValue` in `exitStates`)."""
    found: dict[str, tuple[str, ...]] = {}
    for parent in left:
        for history in parent.histories:
            assert history.state is not None  # only the document has no state
            if history.state.deep:
                kept = [n for n in active if n.kind in (StateKind.ATOMIC, StateKind.FINAL) and n.lies_below(parent)]
            else:
                kept = [n for n in active if n.parent is parent]
            found[history.path] = tuple(n.path for n in sorted(kept, key=lambda n: n.index))
    return found
