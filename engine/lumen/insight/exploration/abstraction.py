"""The rule by which two snapshots count as one configuration: irrelevant parts are left out, numbers are limited."""

import re
from bisect import bisect_left
from collections.abc import Iterator, Mapping
from typing import Any

from lumen.expressions import names
from lumen.expressions.tree import FunctionCall, Literal, path_of, walk
from lumen.insight.exploration.expression_uses import ExpressionUse, of_state, property_trees
from lumen.insight.exploration.history_uses import history_uses
from lumen.insight.exploration.liveness import Liveness
from lumen.language.machines import MachineDefinition
from lumen.language.numbers import is_number
from lumen.statechart import Awaiting, Fork, Invoked, Position, Snapshot, Within

MAX_ITEMS_COMPARED = 4
"""The maximum number of items of a list or map in the context that are compared; further items are ignored."""

ConfigurationKey = tuple[Any, ...]
"""The hashable key of a configuration."""


class Abstraction:
    """The key of a snapshot; snapshots with equal keys count as one configuration.

    Only context keys that can still matter count. A number counts as itself within the range of numbers that the
    behaviour mentions, else as below or above all of them. A text counts as empty, as a mentioned text, or as another
    text. If the behaviour uses `size`, the lengths of texts, lists and maps count as numbers too.

    Of a `for`, the entry and the number of entries left count; of a history, only the part that it can still restore.
    Times, ids, random numbers and (unless a guard reads it) the language do not count.
    """

    def __init__(self, machine: MachineDefinition) -> None:
        self._machine = machine
        self._liveness, self._histories = Liveness(machine), history_uses(machine)
        self._loops = frozenset(s.for_each.key for s in machine.states.values() if s.for_each)
        every = (use for state in machine.states.values() for use in of_state(state))
        self._asked = [ExpressionUse(tree) for tree in property_trees(machine.properties)]
        self._always_live = frozenset(key for use in self._asked for key in names(use.tree).context)
        uses = [*self._asked, *(use for use in every if not self._goes_on(use))]
        literals = {node.value for use in uses for node, _ in walk(use.tree) if isinstance(node, Literal)}
        self._texts = {value for value in literals if isinstance(value, str)}
        self._numbers = sorted({v for v in literals if is_number(v)} | {0})
        self._sized = any(
            isinstance(n, FunctionCall) and n.function == "size" for use in uses for n, _ in walk(use.tree)
        )
        self._language = any(re.search(r"\b(state\.language|in_language)\b", t) for t in _guards(machine))
        self._sorted: dict[frozenset[str], tuple[str, ...]] = {}
        self._inner = {behavior: Abstraction(inner) for behavior, inner in machine.invoked.items()}

    def key(self, snapshot: Snapshot) -> ConfigurationKey:
        """Return the key of the configuration that a snapshot belongs to."""
        live = self._liveness.of(snapshot.configuration, snapshot.history)
        if live not in self._sorted:
            self._sorted[live] = tuple(sorted(live | self._always_live))
        return (
            snapshot.configuration,
            tuple((k, self._known(k, snapshot.context.get(k))) for k in self._sorted[live]),
            tuple(sorted((t.event if t.kind != "wait" else "", t.state, t.kind, t.to) for t in snapshot.timers)),
            tuple((path, _shape(position)) for path, position in sorted(snapshot.doing.items())),
            tuple(self._remembered(snapshot)),
            snapshot.language if self._language else "",
            snapshot.place,
            tuple(self._child(id, child) for id, child in sorted(snapshot.invoked.items())),
        )

    def _goes_on(self, use: ExpressionUse) -> bool:
        """Return whether an expression steps a `for` through its list: numbers in such expressions do not count."""
        paths = [path_of(node) for node, _ in walk(use.tree)]
        return any(path and path[0] == "context" and "left" in path and path[1] in self._loops for path in paths)

    def _known(self, key: str, value: Any) -> Any:
        """Return the relevant part of a context value; of a `for`, that is the entry and the number of entries left."""
        return (self.value(value["entry"]), len(value["left"])) if key in self._loops else self.value(value)

    def _remembered(self, snapshot: Snapshot) -> Iterator[tuple[Any, ...]]:
        """Yield the content of each history that can still be restored."""
        for history, paths in sorted(snapshot.history.items()):
            if self._histories[history] & snapshot.configuration:
                halted = [(path, _shape(at.position)) for path, at in sorted(snapshot.halted.items()) if path in paths]
                yield (history, paths, *halted)

    def _child(self, id: str, child: Invoked) -> ConfigurationKey:
        behavior = self._machine.invoked_behavior(child.state, id)
        return (id, behavior, self._inner[behavior].key(child.snapshot))

    def value(self, value: Any) -> Any:
        """Return a hashable form of a value's relevant part."""
        if value is None or isinstance(value, bool):
            return value
        if isinstance(value, int | float):
            return self._number(value)
        if isinstance(value, str):
            known = value if not value or value in self._texts else "…"
            return (known, self._number(len(value))) if self._sized else known
        if isinstance(value, Mapping):
            items: tuple[Any, ...] = tuple((k, self.value(v)) for k, v in sorted(value.items())[:MAX_ITEMS_COMPARED])
        else:
            items = tuple(self.value(item) for item in value[:MAX_ITEMS_COMPARED])
        return (items, self._number(len(value))) if self._sized else items

    def _number(self, value: float) -> tuple[int, float]:
        least, most = self._numbers[0] - 1, self._numbers[-1] + 1
        near = value if value == int(value) else bisect_left(self._numbers, value) - 0.5
        return (0, near) if least <= value <= most else (-1 if value < least else 1, 0)


def _guards(machine: MachineDefinition) -> Iterator[str]:
    return (t.guard.source for state in machine.states.values() for t in state.transitions if t.guard)


def _shape(position: Position | None) -> Any:
    match position:
        case Within(block, place, inner):
            return (block, place, _shape(inner))
        case Fork(branches):
            return tuple(_shape(branch) for branch in branches)
        case Awaiting(id, _):
            return "wait" if id.startswith("w") else "command"
    return None
