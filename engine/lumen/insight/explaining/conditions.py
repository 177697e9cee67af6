"""Evaluates a guard again: whether it is true, its parts with their values, and the first part that is false."""

from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

from lumen.expressions import ExpressionError, Scope, compile_guard, parse_expression, unparse
from lumen.expressions.readings import looks_at_what_was_heard, readings
from lumen.expressions.tree import ExpressionNode, Logic, path_of, walk
from lumen.language.actions import Expression


class GuardPart(NamedTuple):
    """One of the conditions that `&&` joins in a guard."""

    text: str
    """The condition as written."""
    holds: bool
    """Whether the condition is true. A condition that has no value counts as false (SCXML 5.9.1)."""
    values: Mapping[str, Any]
    """The values that the condition read, by their names in it."""
    error: str = ""
    """Why the condition has no value; empty if it has one."""


def parts(guard: Expression, scope: Scope) -> tuple[GuardPart, ...]:
    """Return the parts of a guard in the order written; a guard without `&&` is one part."""
    meant = tuple(_joined(parse_expression(guard.source)))
    try:
        shown = tuple(_joined(parse_expression(guard.shown)))
    except ExpressionError:  # some guards are shown in words, such as: there is a next exhibit
        return (_part(parse_expression(guard.source), guard.shown, scope),)
    if len(meant) != len(shown):
        shown = meant
    return tuple(_part(one, unparse(other), scope) for one, other in zip(meant, shown, strict=True))


def first_false(guard: Expression, scope: Scope) -> GuardPart | None:
    """Return the first part that is not true; None if the whole guard is true."""
    if holds(guard, scope):
        return None
    return next((part for part in parts(guard, scope) if not part.holds), None)


def holds(guard: Expression | None, scope: Scope) -> bool:
    """Return whether a guard is true; None counts as true, and a guard that has no value as false."""
    try:
        return guard is None or compile_guard(guard.source)(scope)
    except ExpressionError:
        return False


def values(guard: Expression | None, scope: Scope) -> dict[str, Any]:
    """Return the values that a guard read, by their names in it."""
    return readings(guard.source, scope, guard.shown) if guard else {}


def awaits_event(source: str) -> tuple[bool, ...]:
    """Return for each part of a guard whether it reads the event, and thus has no value before an event."""
    return tuple(
        any((path_of(node) or ("",))[0] == "event" or looks_at_what_was_heard(node) for node, _ in walk(part))
        for part in _joined(parse_expression(source))
    )


def _joined(tree: ExpressionNode) -> Iterator[ExpressionNode]:
    if isinstance(tree, Logic) and tree.sign == "&&":
        for operand in tree.operands:
            yield from _joined(operand)
    else:
        yield tree


def _part(node: ExpressionNode, shown: str, scope: Scope) -> GuardPart:
    source = unparse(node)
    found = readings(source, scope, shown)
    try:
        return GuardPart(shown, compile_guard(source)(scope), found)
    except ExpressionError as error:
        return GuardPart(shown, False, found, str(error))
