"""The states that transitions exit and enter: the sets of SCXML's Appendix D, by its names."""

from collections.abc import Iterable, Mapping, Sequence
from collections.abc import Set as AbstractSet

from lumen.language.machines import StateKind
from lumen.statechart.chart import Chart, CompiledTransition, StateNode
from lumen.statechart.history import History


class EntrySet(set[StateNode]):
    """The states that a microstep enters."""

    def __init__(self) -> None:
        super().__init__()
        self.reached: set[StateNode] = set()
        """These states and all their ancestors."""

    def enter(self, node: StateNode) -> None:
        """Add a state, and mark its ancestors as reached."""
        self.add(node)
        self.reached.update((node, *node.ancestors))


class StateSets:
    """The sets of one chart with one history; `staying` are the active states that are not exited.

    Three rules go beyond the pseudocode of Appendix D, but follow from the definitions of 3.13 and keep configurations
    legal. Active states that stay are not entered, even if a history inside them is the target. If one target contains
    another, the inner one determines how the outer one is entered. A transition enters states inside the domain that it
    exited, even if a history among its targets remembers other states by now.
    """

    def __init__(self, chart: Chart, history: History, staying: AbstractSet[StateNode] = frozenset()) -> None:
        self.chart = chart
        self.history = history
        self.staying = staying

    def exit_set(self, transitions: Iterable[CompiledTransition], active: AbstractSet[StateNode]) -> set[StateNode]:
        """Return the active states that these transitions exit (`computeExitSet`)."""
        left: set[StateNode] = set()
        for transition in transitions:
            if transition.targets:
                domain = self.domain(transition)
                left.update(node for node in active if node.lies_below(domain))
        return left

    def without_conflicts(
        self, enabled: Sequence[CompiledTransition], active: AbstractSet[StateNode]
    ) -> tuple[CompiledTransition, ...]:
        """Return the transitions that can be taken together (`removeConflictingTransitions`)."""
        kept: dict[CompiledTransition, set[StateNode]] = {}
        taken: set[StateNode] = set()
        for transition in enabled:
            left = self.exit_set([transition], active)
            rivals = [] if taken.isdisjoint(left) else [other for other in kept if kept[other] & left]
            if all(transition.source.lies_below(other.source) for other in rivals):
                for other in rivals:
                    del kept[other]
                kept[transition] = left
                taken |= left
        return tuple(kept)

    def domains(self, transitions: Iterable[CompiledTransition]) -> dict[CompiledTransition, StateNode]:
        """Return the domain of each of these transitions that has a target."""
        return {transition: self.domain(transition) for transition in transitions if transition.targets}

    def entry_set(self, domains: Mapping[CompiledTransition, StateNode]) -> set[StateNode]:
        """Return the states that these transitions enter, each inside its domain (`computeEntrySet`)."""
        entered = EntrySet()
        for transition, domain in domains.items():
            for target in _innermost(transition.targets):
                self.add_descendants(target, entered)
            for target in self.effective(transition.targets):
                self.add_ancestors(target, domain, entered)
        return entered

    def beginning(self) -> set[StateNode]:
        """Return the states that a machine enters at its start."""
        entered = EntrySet()
        self.add_descendants(self.chart.root, entered)
        return entered

    def domain(self, transition: CompiledTransition) -> StateNode:
        """Return the state inside which a transition exits and enters states (`getTransitionDomain`)."""
        source, targets = transition.source, self.effective(transition.targets)
        inside = source.kind is StateKind.COMPOUND and all(target.lies_below(source) for target in targets)
        if inside and not transition.definition.reenter:
            return source
        return _lcca([source, *targets])

    def effective(self, targets: Sequence[StateNode]) -> list[StateNode]:
        """Return the targets, with histories replaced by the states they recall (`getEffectiveTargetStates`)."""
        found: list[StateNode] = []
        for target in targets:
            found += self.effective(self.recalled(target)) if target.kind is StateKind.HISTORY else [target]
        return list(dict.fromkeys(found))

    def recalled(self, history: StateNode) -> Sequence[StateNode]:
        """Return the states that a history state remembers, else its default."""
        if history.path in self.history:
            return [self.chart.nodes[path] for path in self.history[history.path]]
        return history.initial

    def add_descendants(self, node: StateNode, entered: EntrySet) -> None:
        """Add a state and the descendants that are entered with it (`addDescendantStatesToEnter`)."""
        if node.kind is StateKind.HISTORY:
            assert node.parent is not None  # only the document has no parent
            self._add_all(self.recalled(node), node.parent, entered)
            return
        entered.enter(node)
        if node.kind is StateKind.COMPOUND:
            self._add_all(node.initial, node, entered)
        elif node.kind is StateKind.PARALLEL:
            self._add_regions(node, entered)

    def add_ancestors(self, node: StateNode, top: StateNode, entered: EntrySet) -> None:
        """Add the inactive ancestors of a state below `top`, and their other regions (`addAncestorStatesToEnter`)."""
        for ancestor in node.below(top):
            if ancestor in self.staying:
                return
            entered.enter(ancestor)
            if ancestor.kind is StateKind.PARALLEL:
                self._add_regions(ancestor, entered)

    def reach(self, targets: Sequence[StateNode], entered: EntrySet) -> None:
        """Add these states and their ancestors, from the outermost that is inactive."""
        self._add_all(targets, self.chart.document, entered)

    def fill(self, node: StateNode, entered: EntrySet) -> None:
        """Add the missing descendants of a state that is active already."""
        if node.kind is StateKind.PARALLEL:
            self._add_regions(node, entered)
        else:
            self._add_all(node.initial, node, entered)

    def _add_all(self, nodes: Sequence[StateNode], top: StateNode, entered: EntrySet) -> None:
        for node in _innermost(nodes):
            self.add_descendants(node, entered)
        for node in nodes:
            self.add_ancestors(node, top, entered)

    def _add_regions(self, parallel: StateNode, entered: EntrySet) -> None:
        for region in parallel.children:
            if region not in entered.reached:
                self.add_descendants(region, entered)


def in_final(node: StateNode, active: AbstractSet[StateNode]) -> bool:
    """Return True if a state has finished (`isInFinalState`)."""
    if node.kind is StateKind.COMPOUND:
        return any(child.kind is StateKind.FINAL and child.parent is node for child in active)
    if node.kind is StateKind.PARALLEL:
        return all(in_final(child, active) for child in node.children)
    return node.kind is StateKind.FINAL and node in active


def _innermost(nodes: Sequence[StateNode]) -> list[StateNode]:
    around = {ancestor for node in nodes for ancestor in node.ancestors}
    return [node for node in nodes if node not in around]


def _lcca(nodes: Sequence[StateNode]) -> StateNode:
    """Return the least common ancestor that is compound, or the document; never a parallel state (`findLCCA`)."""
    head, *tail = nodes
    compound = (a for a in head.ancestors if a.kind is StateKind.COMPOUND)
    return next(a for a in compound if all(node.lies_below(a) for node in tail))
