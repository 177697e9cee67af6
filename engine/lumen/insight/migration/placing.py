"""Finds the states that stay, are left and are entered, to make the configuration legal in the new machine."""

from collections.abc import Iterable, Iterator, Mapping
from typing import NamedTuple

from lumen.language.machines import MachineDefinition, StateKind, Transition
from lumen.statechart.chart import Chart, CompiledTransition, StateNode
from lumen.statechart.history import History
from lumen.statechart.state_sets import EntrySet, StateSets

CONTEXT_PREFIX = "context."
"""The prefix of context keys in `renamed`: `context.name: context.visitor`."""


class Identity:
    """Maps states and context keys of an old machine to a new machine.

    A renaming that the old machine's file already contains was applied before, and does not count. A renamed state
    includes the states below it. With `back`, the new machine ran before, and the old machine's renamings are undone.
    """

    def __init__(self, old: MachineDefinition, new: MachineDefinition, *, back: bool = False) -> None:
        self._new = new
        fresh = {_path(old, name): now for name, now in new.renamed.items() if old.renamed.get(name) != now}
        past = {now: _path(new, name) for name, now in old.renamed.items() if new.renamed.get(name) != now}
        again = {now: new.renamed[name] for now, name in past.items() if name in new.renamed}
        self._first: Mapping[str, str] = {n: was for n, was in past.items() if self._known(was)} if back else fresh
        self._last: Mapping[str, str] = {} if back else again

    def state(self, path: str) -> str | None:
        """Return a state's path in the new machine; None if the state was removed."""
        for table in (self._first, {path: path}, self._last):
            for prefix in _prefixes(path):
                if prefix in table:
                    found = table[prefix] + path[len(prefix) :]
                    if found in self._new.states:
                        return found
                    if table is self._first:
                        return None
                    break
        return None

    def keys(self) -> Mapping[str, str]:
        """Return for each key of the new context its name in the old machine."""
        names = {key: key for key in self._new.context}
        for table in (self._last, self._first):
            for was, now in table.items():
                if was.startswith(CONTEXT_PREFIX) and now.removeprefix(CONTEXT_PREFIX) in names:
                    names[now.removeprefix(CONTEXT_PREFIX)] = was.removeprefix(CONTEXT_PREFIX)
        return names

    def _known(self, name: str) -> bool:
        return name in self._new.states or name.removeprefix(CONTEXT_PREFIX) in self._new.context


def _path(machine: MachineDefinition, name: str) -> str:
    """Return the path of the state with the id `name`; if there is none, `name` itself."""
    if name in machine.states:
        return name
    return next((path for path, state in machine.states.items() if path and state.alias == name), name)


def _prefixes(path: str) -> Iterator[str]:
    """Yield a path and the paths of the states around it, longest first."""
    while path:
        yield path
        path = path.rpartition(".")[0]


class Placement(NamedTuple):
    """The places of the active states in a new chart."""

    kept: Mapping[StateNode, StateNode]
    """The new state for each old state that stays active."""
    left: frozenset[StateNode]
    """The old states that are left."""
    entered: frozenset[StateNode]
    """The new states that are entered."""


class Unplaced(NamedTuple):
    """A compound state without exactly one active child, for which no `onReload` names another state."""

    state: StateNode
    """The compound state, in the new chart."""
    gone: StateNode
    """The innermost old state that has no place."""
    rivals: tuple[StateNode, ...] = ()
    """Active children that can no longer be active together; empty if there is at most one."""


def place(new: Chart, active: frozenset[StateNode], identity: Identity, history: History) -> Placement | Unplaced:
    """Place an old chart's active states in the new chart, which has `history`; return Unplaced if that fails.

    States that stay are not entered again. If a compound state has lost its active child, the nearest `onReload` around
    it decides; a state that had no children before enters its initial state.
    """
    placing = _Placing(new, active, identity)
    while (empty := placing.unplaced()) is not None:
        if not placing.lead(empty, history):
            standing = placing.standing()
            rivals = tuple(child for child in empty.children if child in standing)
            return Unplaced(empty, _gone(empty, active, placing), rivals)
    return placing.finish(history)


class _Placing:
    """Searches for a legal configuration with the states that stay."""

    def __init__(self, new: Chart, active: frozenset[StateNode], identity: Identity) -> None:
        self.new, self.active = new, active
        self.goals: list[StateNode] = []
        self.images = {node: self._image(node, identity) for node in active}
        self.kept: dict[StateNode, StateNode] = {}
        for leaf in sorted(_leaves(active), key=lambda node: node.index):
            self._keep(leaf)

    def _image(self, node: StateNode, identity: Identity) -> StateNode | None:
        path = identity.state(node.path) if node.path else ""
        found = None if path is None else self.new.nodes[path]
        return None if found and found.kind is StateKind.HISTORY else found

    def _keep(self, leaf: StateNode) -> None:
        """Keep a leaf and the ancestors that still surround it.

        If the leaf was removed, keep its nearest ancestor that stays, and the ancestors around that state.
        """
        chain = [node for node in (leaf, *leaf.ancestors) if node in self.images]
        anchor = next(image for node in chain if (image := self.images[node]) is not None)
        around = {anchor, *anchor.ancestors}
        for node in chain:
            image = self.images[node]
            if image is None or image not in around or image in self.kept.values():
                continue
            if image.kind is StateKind.FINAL and node.kind is not StateKind.FINAL:
                self.goals.append(image)
            else:
                self.kept[node] = image

    def standing(self) -> set[StateNode]:
        """Return every state that certainly stays or is entered, and the states around them."""
        found = {*self.kept.values(), *self.goals}
        return found.union(*(node.ancestors for node in found))

    def unplaced(self) -> StateNode | None:
        """Return a compound state that lacks a single active child and can't enter its initial state; else None.

        If there are several such states, the outermost is returned.
        """
        standing = self.standing()
        begins = {self.kept[leaf] for leaf in _leaves(self.active) if leaf in self.kept} | set(self.goals)
        for node in sorted(standing, key=lambda node: node.index):
            active = sum(child in standing for child in node.children)
            if node.kind is StateKind.COMPOUND and node is not self.new.document and node not in begins and active != 1:
                return node
        return None

    def lead(self, empty: StateNode, history: History) -> bool:
        """Follow the nearest `onReload` around a state, and drop the states in its domain; return False if none."""
        source = next((n for n in (empty, *empty.ancestors) if n.state and n.state.on_reload), None)
        if source is None or source.state is None:
            return False
        target = self.new.nodes[source.state.on_reload]
        domain = StateSets(self.new, history).domain(CompiledTransition(Transition(empty.path), empty, (target,)))
        self.kept = {node: image for node, image in self.kept.items() if not image.lies_below(domain)}
        self.goals = [goal for goal in self.goals if not goal.lies_below(domain)]
        self.goals += StateSets(self.new, history).effective([target])
        return True

    def finish(self, history: History) -> Placement:
        """Return the placement, completed by the states around, beside and within the states that stay."""
        staying = frozenset(self.kept.values())
        topology = StateSets(self.new, history, staying)
        entered = EntrySet()
        entered.reached |= self.standing()
        topology.reach(self.goals, entered)
        for node in staying:
            topology.add_ancestors(node, self.new.document, entered)
        for node in sorted(staying, key=lambda node: node.index):
            if node.kind is StateKind.PARALLEL or not any(child in entered.reached for child in node.children):
                topology.fill(node, entered)
        left = frozenset(node for node in self.active if node not in self.kept)
        return Placement(self.kept, left, frozenset(entered - staying))


def is_legal(chart: Chart, active: Iterable[StateNode]) -> bool:
    """Return whether states form a configuration (SCXML 3.11): one child of a compound, all of a parallel state."""
    known = set(active)
    counts = {node: sum(child in known for child in node.children) for node in known}
    needed = {node: {StateKind.COMPOUND: 1, StateKind.PARALLEL: len(node.children)}.get(node.kind, 0) for node in known}
    around = all(node is chart.root or node.parent in known for node in known)
    return chart.root in known and around and counts == needed


def _leaves(active: frozenset[StateNode]) -> Iterator[StateNode]:
    return (node for node in active if not any(child in active for child in node.children))


def _gone(empty: StateNode, active: frozenset[StateNode], placing: _Placing) -> StateNode:
    """Return the innermost old state in `empty` that does not stay."""
    left = [node for node in active if node not in placing.kept]
    inside = [n for n in left if any(placing.kept.get(a) is empty for a in n.ancestors)]
    return max(inside or left or list(active), key=lambda node: node.index)
