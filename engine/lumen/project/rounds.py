"""Convert `for` of a state, which runs its content once for each entry of a list, to a statechart without `for`.

A key of the context holds the current entry and the remaining ones. The state begins in an added final child. Whenever
the state is done and an entry is left, that entry becomes the current one, and the state begins with its first child.
After the last entry, the file's own `onDone` applies. Expressions inside use `context.KEY.entry` in place of the
entry's name in the file, such as `question`.
"""

import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from typing import Any

from lumen.expressions.functions import CAUGHT
from lumen.language.actions import Assign, Expression, PlacedAction
from lumen.language.diagnostics import ERROR, Code, NodePath
from lumen.language.machines import ForEach, State, StateKind, Transition
from lumen.language.shared import SHARED
from lumen.project.document_report import DocumentReport
from lumen.project.outline import BehaviorOutline, OutlinedState
from lumen.talk.hearing import HEARD

BAD_FOR = Code("bad-for", "statecharts", ERROR, "a `for` can't run through its list here")

NOTHING_YET: Mapping[str, Any] = {"entry": {}, "left": []}
"""The value of the context key of a `for` before the state is entered."""

ReadExpression = Callable[[str, NodePath], Expression | None]

_TAKEN = frozenset(("context", "event", "state", "lists", HEARD))
_WITHIN = (("states",), ("on",), ("hears",), ("after",), ("at",))
"""The parts of a state with `for` in which its entry is defined; `initial` and `onDone` are not among them."""


class Rounds:
    """The `for`s of one document, by the paths of their states.

    If `shared` is true, the shared keys are defined everywhere.
    """

    def __init__(
        self, outline: BehaviorOutline, report: DocumentReport, context: Mapping[str, Any], *, shared: bool = False
    ) -> None:
        self.report = report
        self.known = {SHARED: f"context.{SHARED}"} if shared else {}
        self.by_place: dict[NodePath, tuple[str, str]] = {}
        self.keys: dict[str, str] = {}
        self.rows: dict[NodePath, int] = {}
        """The number of each row of `hears`, by its path; `heard` is defined inside these rows."""
        for entry in outline.entries.values():
            if "for" in entry.data and self._sound(entry):
                name, key = entry.data["for"]["as"], self._key(entry, context)
                self.keys[entry.path] = key
                self.by_place[entry.where] = name, key

    def variables(self, where: NodePath) -> dict[str, str]:
        """Return the names that `for`, `hears` and `shared` define at a path, and the expressions that replace them."""
        found = dict(self.known)
        for place, (name, key) in self.by_place.items():
            if where[: len(place)] == place and where[len(place) : len(place) + 1] in _WITHIN:
                found[name] = f"context.{key}.entry"
        if "hears" in where:
            row = next((self.rows[where[:n]] for n in range(len(where), 0, -1) if where[:n] in self.rows), None)
            if row is not None:
                found[HEARD] = f"{CAUGHT}({row})"
        return found

    def read(self, entry: OutlinedState, expression: ReadExpression) -> ForEach | None:
        """Return the `for` of a state; None if the state has no `for`, or one that can't be read."""
        if entry.path not in self.keys:
            return None
        data, where = entry.data["for"], (*entry.where, "for")
        each = expression(data["each"], (*where, "each"))
        if each is None:
            return None
        key = self.keys[entry.path]
        return ForEach(each, data["as"], key, data.get("shuffle", False), data.get("most"), where)

    def elsewhere(self, name: str) -> str:
        """Return the dotted path of the state whose `for` defines this name; empty if no `for` does."""
        return next((".".join(map(str, at[1::2])) for at, (known, _) in self.by_place.items() if known == name), "")

    def _sound(self, entry: OutlinedState) -> bool:
        """Return True if a state may have a `for` and its name is free; otherwise, report the fault."""
        name, where = entry.data["for"]["as"], (*entry.where, "for")
        if entry.kind is not StateKind.COMPOUND:
            if entry.kind in (StateKind.ATOMIC, StateKind.PARALLEL):
                hint = "give it `states`, one of them final: when the final state is reached, the next entry begins"
                message = f"{entry.title} has no states to run for each entry"
                self.report(BAD_FOR, where, message, hint, key=True)
            return False
        if entry.parent and entry.parent.kind is StateKind.PARALLEL:
            hint = "put the `for` into a state inside the region"
            self.report(
                BAD_FOR,
                where,
                f"{entry.title} is a region of a parallel state, which can't have a `for`",
                hint,
                key=True,
            )
            return False
        broken = any(self.report.broken((*child.where, "type")) for child in entry.children.values())
        if not broken and not any(child.kind is StateKind.FINAL for child in entry.children.values()):
            hint = "add a state with `type: final`: when it is reached, the next entry begins"
            self.report(
                BAD_FOR, where, f"{entry.title} never gets to a second entry: it has no final state", hint, key=True
            )
        outer = [p for p, (other, _) in self.by_place.items() if other == name and entry.where[: len(p)] == p]
        if name in _TAKEN or name in self.known or outer:
            what = "the entry of an outer `for`" if outer else "a name with a fixed meaning in expressions"
            self.report(BAD_FOR, (*where, "as"), f"`{name}` is already {what}", "choose another name")
            return False
        return True

    def _key(self, entry: OutlinedState, context: Mapping[str, Any]) -> str:
        key = f"{entry.data['for']['as']}_in_{re.sub(r'[^A-Za-z0-9]', '_', entry.path)}"
        while key in context or key in self.keys.values():
            key += "_"
        return key


def unrolled(state: State, first: tuple[str, ...]) -> Iterator[State]:
    """Yield a state with a `for` as a plain statechart, then its added final child; `first` are its initial states."""
    loop = state.for_each
    assert loop is not None
    where, key = loop.where, f"context.{loop.key}"
    order = f"shuffle({loop.each.source})" if loop.shuffle else loop.each.source
    order = order if loop.most is None else f"take({order}, {loop.most})"

    def assign(source: str) -> tuple[PlacedAction, ...]:
        return (PlacedAction(Assign({loop.key: Expression(source, where)}), where),)

    begin = assign(f"{{'entry': {{}}, 'left': {order}}}")
    following = assign(f"{{'entry': {key}.left[0], 'left': drop({key}.left, 1)}}")
    more = Expression(f"size({key}.left) > 0", where, f"there is a next {loop.variable}")
    onward = Transition(state.path, f"done.state.{state.name}", first, more, following, exact=True, where=where)
    name = "begin"
    while f"{state.path}.{name}" in state.children:
        name += "_"
    child = State(f"{state.path}.{name}", StateKind.FINAL, state.path, entry=begin, where=where)
    transitions = (onward, *state.transitions)
    yield replace(state, children=(*state.children, child.path), initial=(child.path,), transitions=transitions)
    yield child
