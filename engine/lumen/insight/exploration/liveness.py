"""The context keys that can still matter in a state: those that are read before they get a new value.

For example, the number of a visitor's attempts does not matter if no state reads it again, so configurations that
differ only in that number are one. A history restores only what it remembers.
"""

from collections.abc import Iterator, Mapping
from itertools import pairwise

from lumen.expressions import ExpressionNode, names, unparse
from lumen.expressions.function_table import clock_functions
from lumen.expressions.functions import CAUGHT
from lumen.expressions.tree import Binary, FieldAccess, FunctionCall, Literal, Logic, Unary, children
from lumen.insight.exploration.expression_uses import of_state, relevant, tree_of
from lumen.insight.exploration.history_uses import history_uses
from lumen.language.actions import Assign, ComputedValue, Expression, PlacedAction, context_key
from lumen.language.machines import MachineDefinition, State, StateKind, Transition, transition_domain
from lumen.talk.hearing import always_caught


def assigned_on_entry(block: tuple[PlacedAction, ...]) -> frozenset[str]:
    """Return the keys to which a block certainly assigns new values that do not depend on the old values."""
    return frozenset(
        key
        for step in block
        if isinstance(step.action, Assign)
        for key, value in step.action.values.items()
        if context_key(key) == key and _certain(value)
    )


def assigned_by(transition: Transition, caught: frozenset[str] = frozenset()) -> frozenset[str]:
    """Return the keys to which a transition's actions certainly assign values, up to the first action that can fail.

    An expression that the true guard has already evaluated from the event alone can't fail. `caught` are the keys that
    `heard` certainly has there.
    """
    guard = tree_of(transition.guard.source) if transition.guard else None
    known = {unparse(node) for node in _computed(guard)} if guard else set()
    found: set[str] = set()
    for step in transition.actions:
        if not isinstance(step.action, Assign):
            break
        for key, value in step.action.values.items():
            if not (_certain(value) or (isinstance(value, Expression) and _again(value, known, caught))):
                return frozenset(found)
            if context_key(key) == key:
                found.add(key)
    return frozenset(found)


def _certain(value: ComputedValue) -> bool:
    """Return whether a value is certain: an expression can fail, unless it is a literal."""
    return not isinstance(value, Expression) or isinstance(tree_of(value.source), Literal)


def _again(value: Expression, known: set[str], caught: frozenset[str]) -> bool:
    match tree := tree_of(value.source):
        case FunctionCall("in_language", (FieldAccess(FunctionCall(function), name),)) if function == CAUGHT:
            return name in caught
    return tree is not None and unparse(tree) in known


def _computed(tree: ExpressionNode) -> Iterator[ExpressionNode]:
    """Yield the parts of a true guard that were certainly evaluated and have the same value for the same event."""
    speaks = names(tree)
    if not speaks.context and not speaks.functions & {"In", *clock_functions()}:
        yield tree
    match tree:
        case Binary() | Unary() | Logic(sign="&&"):  # `||` treats an error as false, so an operand may have failed
            parts = tuple(children(tree))
        case FunctionCall(function=function) if function != "has":
            parts = tuple(children(tree))
        case _:
            parts = ()
    for part in parts:
        yield from _computed(part)


class Liveness:
    """The keys that can still matter, by atomic state."""

    def __init__(self, machine: MachineDefinition) -> None:
        self._machine = machine
        self.keys = relevant(machine)
        self._reads = {path: self._read(state) for path, state in machine.states.items()}
        self._kills = {path: self._killed(state) for path, state in machine.states.items()}
        self._histories = history_uses(machine)
        leaves = [s.path for s in machine.states.values() if s.kind in (StateKind.ATOMIC, StateKind.FINAL)]
        self._next = {leaf: tuple(self._successors(leaf)) for leaf in leaves}
        self._live = self._solve(leaves)
        names_of = {s.name: s.path for s in machine.states.values() if s.path}
        self._by_name = {name: self._live.get(path, frozenset()) for name, path in names_of.items()}
        self._without_history: dict[frozenset[str], frozenset[str]] = {}

    def of(self, configuration: frozenset[str], history: Mapping[str, tuple[str, ...]]) -> frozenset[str]:
        """Return the keys that can still matter in a configuration; `history` has the paths that histories remember."""
        live = self._without_history.get(configuration)
        if live is None:
            live = frozenset().union(*(self._by_name[name] for name in configuration))
            self._without_history[configuration] = live
        again = [path for name, paths in history.items() if self._histories[name] & configuration for path in paths]
        leaves = [leaf for path in again for leaf in self._below(path)]
        return live.union(*(self._live.get(leaf, frozenset()) for leaf in leaves)) if leaves else live

    def _read(self, state: State) -> frozenset[str]:
        uses = (use for use in of_state(state) if not use.key or use.key in self.keys)
        return frozenset(key for use in uses for key in names(use.tree).context)

    def _killed(self, state: State) -> frozenset[str]:
        """Return the keys that entering a state certainly overwrites and that no state around it can read first."""
        return assigned_on_entry(state.entry).difference(*(self._reads[path] for path in self._around(state.path)))

    def _solve(self, leaves: list[str]) -> Mapping[str, frozenset[str]]:
        """Return the keys that matter in each leaf: those read in or around it, or after a transition from it."""
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
        """Yield the leaves that transitions of a leaf or around it can enter, each with the keys overwritten then."""
        for transition in (tr for path in self._around(leaf) for tr in self._machine.states[path].transitions):
            killed = assigned_by(transition, self._caught(transition))
            domain = transition_domain(self._machine, transition)
            for target in transition.targets:
                for after in sorted(self._entered(target, domain)):
                    yield after, self._kills[after] | killed
        for after in sorted(self._left_and_entered_again(leaf)):
            yield after, frozenset()

    def _caught(self, transition: Transition) -> frozenset[str]:
        """Return the keys that `heard` always has in the actions of a row of `hears`."""
        return always_caught(self._machine, transition.hears) if transition.hears else frozenset()

    def _entered(self, target: str, domain: str) -> set[str]:
        """Return the leaves below a target, and those of parallel regions that are entered with it in that domain.

        For a history these are its default leaves: `of` adds what it remembers.
        """
        state = self._machine.states[target]
        if state.kind is StateKind.HISTORY:
            found = {leaf for path in state.initial for leaf in self._entered(path, domain)}
        else:
            found = set(self._below(target))
        while state.parent is not None and state.path != domain:
            parent = self._machine.states[state.parent]
            if parent.kind is StateKind.PARALLEL:
                found |= set(self._below(parent.path))
            state = parent
        return found

    def _left_and_entered_again(self, leaf: str) -> Iterator[str]:
        """Yield the leaves that a history can restore if this leaf or a state around it was active."""
        around = list(self._around(leaf))
        histories = [state for state in self._machine.states.values() if state.kind is StateKind.HISTORY]
        homes = {state.parent for state in histories}
        shallow = {state.parent for state in histories if not state.deep}
        for inner, outer in pairwise(around):
            if outer in shallow:
                yield from self._below(inner)
            elif outer in homes:
                yield leaf

    def _below(self, path: str) -> Iterator[str]:
        state = self._machine.states[path]
        if state.kind in (StateKind.ATOMIC, StateKind.FINAL):
            yield path
        for child in state.children:
            yield from self._below(child)

    def _around(self, path: str) -> Iterator[str]:
        """Yield the path of a state and of every state around it, innermost first."""
        place: str | None = path
        while place is not None:
            yield place
            place = self._machine.states[place].parent
