"""Which context keys can still matter where a behaviour stands: those read before they are given a new value.

The number of a visitor's tries to tell a name means nothing once nobody will ask for it again; two configurations that
differ in it alone are one.
"""

from collections.abc import Iterator, Mapping

from lumen.interpreters.exploration.expression_uses import of_state, relevant, tree_of
from lumen.interpreters.expressions import names
from lumen.interpreters.expressions.tree import Literal
from lumen.language.actions import Assign, ComputedValue, Expression, PlacedAction, context_key
from lumen.language.machines import MachineDefinition, State, StateKind


class Liveness:
    """The keys that can still matter, by atomic state."""

    def __init__(self, machine: MachineDefinition) -> None:
        self._machine = machine
        self.keys = relevant(machine)
        self._reads = {path: self._read(state) for path, state in machine.states.items()}
        self._kills = {path: self._killed(state) for path, state in machine.states.items()}
        leaves = [s.path for s in machine.states.values() if s.kind in (StateKind.ATOMIC, StateKind.FINAL)]
        self._next = {leaf: tuple(self._successors(leaf)) for leaf in leaves}
        self._live = self._solve(leaves)
        names_of = {s.name: s.path for s in machine.states.values() if s.path}
        self._by_name = {name: self._live.get(path, frozenset()) for name, path in names_of.items()}

    def of(self, configuration: frozenset[str]) -> frozenset[str]:
        """The keys that can still matter in a configuration."""
        return frozenset().union(*(self._by_name[name] for name in configuration))

    def _read(self, state: State) -> frozenset[str]:
        uses = (use for use in of_state(state) if not use.key or use.key in self.keys)
        return frozenset(key for use in uses for key in names(use.tree).context)

    def _killed(self, state: State) -> frozenset[str]:
        """The keys that surely get new values on entering, and that nothing around it may have read before."""
        return _assigned(state.entry).difference(*(self._reads[path] for path in self._around(state.path)))

    def _solve(self, leaves: list[str]) -> Mapping[str, frozenset[str]]:
        """What is read in a leaf or around it, or live after one of its transitions; until nothing is added."""
        live = {leaf: frozenset().union(*(self._reads[path] for path in self._around(leaf))) for leaf in leaves}
        changed = True
        while changed:
            changed = False
            for leaf in leaves:
                found = live[leaf].union(*(live[after] - killed for after, killed in self._next[leaf]))
                changed |= found != live[leaf]
                live[leaf] = found
        return live

    def _successors(self, leaf: str) -> Iterator[tuple[str, frozenset[str]]]:
        """The leaves that transitions of a leaf or around it may lead to, each with the keys given new values there."""
        targets = {
            t for path in self._around(leaf) for tr in self._machine.states[path].transitions for t in tr.targets
        }
        for target in sorted(targets):
            for after in self._entered(target):
                yield after, self._kills[after]

    def _entered(self, target: str) -> set[str]:
        """The leaves below a target, and those of the regions beside it that may be entered with it."""
        found = set(self._below(target))
        state = self._machine.states[target]
        while state.parent is not None:
            parent = self._machine.states[state.parent]
            if parent.kind is StateKind.PARALLEL or state.kind is StateKind.HISTORY:
                found |= set(self._below(parent.path))
            state = parent
        return found

    def _below(self, path: str) -> Iterator[str]:
        state = self._machine.states[path]
        if state.kind in (StateKind.ATOMIC, StateKind.FINAL):
            yield path
        for child in state.children:
            yield from self._below(child)

    def _around(self, path: str) -> Iterator[str]:
        """The state and all that it lies in."""
        place: str | None = path
        while place is not None:
            yield place
            place = self._machine.states[place].parent


def _assigned(block: tuple[PlacedAction, ...]) -> frozenset[str]:
    """The keys that a block surely gives new values, whatever they were."""
    return frozenset(
        key
        for step in block
        if isinstance(step.action, Assign)
        for key, value in step.action.values.items()
        if context_key(key) == key and _certain(value)
    )


def _certain(value: ComputedValue) -> bool:
    """Whether a value can be had without fail: an expression may have none."""
    return not isinstance(value, Expression) or isinstance(tree_of(value.source), Literal)
