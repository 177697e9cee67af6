"""Questions of Appendix D's pseudo-code about states; every answer is computed from the machine again."""

from collections.abc import Iterable

from lumen.language.machines import MachineDefinition, State, StateKind

SCXML = State("<scxml>", StateKind.COMPOUND, None, children=("",), initial=("",))
"""The element around the root."""


class Tree:
    """The states of a machine, by the names of W3C SCXML 1.0, Appendix D."""

    def __init__(self, machine: MachineDefinition) -> None:
        self.machine = machine

    def parent(self, state: State) -> State | None:
        if state is SCXML:
            return None
        return SCXML if state.parent is None else self.machine.states[state.parent]

    def children(self, state: State) -> list[State]:
        """`getChildStates`: histories are left out."""
        below = [s for s in self.machine.states.values() if self.parent(s) is state]
        return [s for s in below if s.kind is not StateKind.HISTORY]

    def histories(self, state: State) -> list[State]:
        return [s for s in self.machine.states.values() if self.parent(s) is state and s.kind is StateKind.HISTORY]

    def initial(self, state: State) -> list[State]:
        """Return the targets of the transition in `<initial>`, or in a history state."""
        return [self.machine.states[path] for path in state.initial]

    def proper_ancestors(self, state: State, top: State | None) -> list[State]:
        """`getProperAncestors`: none if `top` is not above the state."""
        found: list[State] = []
        above = self.parent(state)
        while above is not None and above is not top:
            found.append(above)
            above = self.parent(above)
        return found if above is top else []

    def is_descendant(self, one: State, other: State) -> bool:
        return other in self.proper_ancestors(one, None)

    def find_lcca(self, states: list[State]) -> State:
        head, *tail = states
        for above in self.proper_ancestors(head, None):
            if above.kind is StateKind.COMPOUND and all(self.is_descendant(s, above) for s in tail):
                return above
        raise AssertionError("everything lies in <scxml>")

    def in_document_order(self, states: Iterable[State]) -> list[State]:
        """Each state once, before its children: the order of entry, and backwards that of exit."""
        wanted = list(states)
        return [s for s in self.machine.states.values() if s in wanted]


def is_atomic(state: State) -> bool:
    return state.kind in (StateKind.ATOMIC, StateKind.FINAL)
