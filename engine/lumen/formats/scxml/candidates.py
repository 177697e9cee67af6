"""Transitions in document order as our `on`: a map, in which each descriptor stands once."""

import re
from typing import Any

from lumen.formats.ecmascript.printing import text_of
from lumen.interpreters.expressions import parse_expression
from lumen.interpreters.expressions.tree import Binary, Call, Field, Literal, Logic, Name, Node

Row = dict[str, Any]


def normal(descriptor: str) -> str:
    """`a` for `a`, `a.` and `a.*` (SCXML 3.12.1)."""
    return "*" if descriptor == "*" else descriptor.removesuffix("*").rstrip(".") if "." in descriptor else descriptor


def overlap(one: str, other: str) -> bool:
    """Whether an event can match both."""
    return "*" in (one, other) or f"{one}.".startswith(f"{other}.") or f"{other}.".startswith(f"{one}.")


def arrange(rows: list[tuple[str, Row]]) -> dict[str, Any]:
    """`on` for these candidates, tried in this order; a descriptor with one candidate has it without a list.

    Where the same descriptor stands before and after one that an event may match as well, all of these become
    candidates of the most general one, which ask for the event's name.
    """
    table: dict[str, list[Row]] = {}
    for descriptor, row in rows:
        if descriptor in table and any(overlap(descriptor, later) for later in _after(table, descriptor)):
            return arrange(_merged(rows, descriptor))
        table.setdefault(descriptor, []).append(row)
    return {descriptor: single(found) for descriptor, found in table.items()}


def single(rows: list[Row]) -> Any:
    """The one row, or the list; a row that is only a target in one place is that text."""
    shown = [row["target"] if set(row) == {"target"} and isinstance(row["target"], str) else row for row in rows]
    return shown[0] if len(shown) == 1 else shown


def _after(table: dict[str, list[Row]], descriptor: str) -> list[str]:
    keys = list(table)
    return keys[keys.index(descriptor) + 1 :]


def _merged(rows: list[tuple[str, Row]], descriptor: str) -> list[tuple[str, Row]]:
    group, size = {descriptor}, 0
    while len(group) > size:
        size = len(group)
        group |= {other for other, _ in rows if any(overlap(other, one) for one in group)}
    general = min(group, key=lambda name: (name != "*", len(name)))
    return [(general if name in group else name, _narrowed(name, general, row)) for name, row in rows]


def _narrowed(name: str, general: str, row: Row) -> Row:
    if name == general:
        return row
    event = Field(Name("event"), "name")
    pattern = re.sub(r"([^\w\s])", r"\\\1", f"{name}.", flags=re.ASCII)
    asked: Node = Logic("||", (Binary("==", event, Literal(name)), Call("matches", (event, Literal(f"^{pattern}")))))
    if "guard" in row:
        guard = parse_expression(row["guard"])
        more = guard.operands if isinstance(guard, Logic) and guard.sign == "&&" else (guard,)
        asked = Logic("&&", (asked, *more))
    return {"guard": text_of(asked), **{key: value for key, value in row.items() if key != "guard"}}
