"""Converts transitions in document order to Lumen's `on`, a map in which each descriptor occurs once."""

import re
from collections.abc import Callable
from typing import Any

from lumen.expressions import parse_expression, unparse
from lumen.expressions.scope import MAX_EXPRESSION_LENGTH, MAX_TREE_DEPTH
from lumen.expressions.tree import (
    Binary,
    ExpressionNode,
    FieldAccess,
    FunctionCall,
    Identifier,
    Literal,
    Logic,
    walk,
)
from lumen.project.formats.behavior_data import TransitionData, single


def arrange(rows: list[tuple[str, TransitionData]], leave_out: Callable[[TransitionData], None]) -> dict[str, Any]:
    """Return `on` for the candidates in `rows`, in this order; a descriptor's only candidate is not in a list.

    If a descriptor comes both before and after another that matches some of the same events, their candidates move to
    the most general descriptor, with guards on the event's name. If a guard becomes too long, its row is passed to
    `leave_out` instead.
    """
    heads = _heads({descriptor for descriptor, _ in rows})
    order, mixed = _DescriptorOrder(), set[str]()
    for descriptor, _ in rows:
        if order.passed(descriptor):
            mixed.add(heads[descriptor])
        order.add(descriptor)
    table: dict[str, list[TransitionData]] = {}
    for descriptor, row in rows:
        head = heads[descriptor] if heads[descriptor] in mixed else descriptor
        narrowed = _narrowed(descriptor, head, row)
        if narrowed is None:
            leave_out(row)
        else:
            table.setdefault(head, []).append(narrowed)
    return {descriptor: single(found) for descriptor, found in table.items()}


def _heads(descriptors: set[str]) -> dict[str, str]:
    """Map each descriptor to the most general one that matches all of its events, possibly itself."""
    return {d: next((general for general in _prefixes(d) if general in descriptors), d) for d in descriptors}


class _DescriptorOrder:
    """The positions of the descriptors so far, and of the last more specific descriptor for each."""

    def __init__(self) -> None:
        self.place: dict[str, int] = {}
        self.below: dict[str, int] = {}

    def add(self, descriptor: str) -> None:
        """Append a descriptor, unless it already has a position."""
        if descriptor not in self.place:
            place = self.place[descriptor] = len(self.place)
            for general in _prefixes(descriptor):
                self.below[general] = place

    def passed(self, descriptor: str) -> bool:
        """Return whether another descriptor that matches some of the same events comes after this one."""
        place = self.place.get(descriptor, len(self.place))
        later = [self.place.get(general, -1) for general in _prefixes(descriptor)]
        return max([self.below.get(descriptor, -1), *later]) > place


def _prefixes(descriptor: str) -> list[str]:
    """Return all more general descriptors, such as `*`, `a` and `a.b` for `a.b.c`; none for `*`."""
    if descriptor == "*":
        return []
    words = descriptor.split(".")
    return ["*", *(".".join(words[:n]) for n in range(1, len(words)))]


def _narrowed(name: str, general: str, row: TransitionData) -> TransitionData | None:
    """Return the row as a candidate of `general`, guarded by its event's name; None if the guard would be too long."""
    if name == general:
        return row
    event = FieldAccess(Identifier("event"), "name")
    pattern = re.sub(r"([^\w\s])", r"\\\1", f"{name}.", flags=re.ASCII)
    asked: ExpressionNode = Logic(
        "||", (Binary("==", event, Literal(name)), FunctionCall("matches", (event, Literal(f"^{pattern}"))))
    )
    if "guard" in row:
        guard = parse_expression(row["guard"])
        more = guard.operands if isinstance(guard, Logic) and guard.sign == "&&" else (guard,)
        asked = Logic("&&", (asked, *more))
    text = unparse(asked)
    fits = len(text) <= MAX_EXPRESSION_LENGTH and all(level <= MAX_TREE_DEPTH for _, level in walk(asked))
    return {"guard": text, **{key: value for key, value in row.items() if key != "guard"}} if fits else None
