"""`abort-if`: an expression over measures, in which `before` is a measure's value for the previous files."""

from collections.abc import Iterator, Mapping
from typing import NamedTuple

from lumen.errors import ExpressionError
from lumen.expressions import Scope, compile_guard, parse_expression
from lumen.expressions.tree import Binary, ExpressionNode, FieldAccess, Identifier, children, walk
from lumen.language.diagnostics import did_you_mean

BEFORE = "before"
COMPARISONS = frozenset(("<", "<=", ">", ">=", "==", "!="))


class ConditionFault(NamedTuple):
    """An error in a condition."""

    offset: int
    """The index of the fault's first character."""
    length: int
    """The number of the fault's characters."""
    message: str
    hint: str


class _Replacement(NamedTuple):
    node: Identifier
    meant: str


def condition_faults(source: str, measures: Mapping[str, object]) -> list[ConditionFault]:
    """Return a condition's first syntax error, else all errors in names, else the compiler's error.

    Return an empty list if the condition can be compiled.
    """
    try:
        tree = parse_expression(source)
    except ExpressionError as error:
        return [ConditionFault(error.offset, 1, error.message, error.hint)]
    found = [fault for row in _replacements(tree, measures, frozenset()) if isinstance(fault := row, ConditionFault)]
    if found:
        return found
    try:
        compile_guard(meant(source, measures))
    except ExpressionError as error:
        return [ConditionFault(0, len(source), error.message, error.hint)]
    return []


def meant(source: str, measures: Mapping[str, object]) -> str:
    """Return the condition as an expression over `context.now` and `context.before`, which map names to measures.

    `errors > 2 * before` becomes `context.now.errors > 2 * context.before.errors`. Raises ExpressionError if the
    condition can't be parsed.
    """
    tree = parse_expression(source)
    rows = [row for row in _replacements(tree, measures, frozenset()) if isinstance(row, _Replacement)]
    for row in sorted(rows, key=lambda row: row.node.offset, reverse=True):
        source = source[: row.node.offset] + row.meant + source[row.node.end :]
    return source


def holds(
    source: str, measures: Mapping[str, object], now: Mapping[str, float], before: Mapping[str, float]
) -> bool | None:
    """Return whether a condition holds; None if it depends on a measure that `now` or `before` lacks."""
    guard = compile_guard(meant(source, measures))
    try:
        return bool(guard(Scope(context={"now": now, BEFORE: before})))
    except ExpressionError:
        return None


def _replacements(
    node: ExpressionNode, measures: Mapping[str, object], around: frozenset[str]
) -> Iterator[_Replacement | ConditionFault]:
    """Yield the replacement or fault of each name; `around` has the names in the comparison that contains `node`."""
    match node:
        case Identifier(name=name):
            yield _named(node, name, measures, around)
            return
        case FieldAccess(base=Identifier(name="before") as base, name=name):
            if name not in measures:
                yield ConditionFault(node.offset, node.end - node.offset, *_unknown(name, measures))
            yield _Replacement(base, f"context.{BEFORE}")
            return
        case Binary(sign=sign) if sign in COMPARISONS:
            around = frozenset(each.name for each, _ in walk(node) if isinstance(each, Identifier)) - {BEFORE}
    for child in children(node):
        yield from _replacements(child, measures, around)


def _named(
    node: Identifier, name: str, measures: Mapping[str, object], around: frozenset[str]
) -> _Replacement | ConditionFault:
    length = node.end - node.offset
    if name != BEFORE:
        if name in measures:
            return _Replacement(node, f"context.now.{name}")
        return ConditionFault(node.offset, length, *_unknown(name, measures))
    known = around & measures.keys()
    if len(known) != 1:
        hint = "write it in a comparison with one measure, as in `errors > 1.5 * before`, or as `before.errors`"
        return ConditionFault(node.offset, length, "`before` has no measure to refer to here", hint)
    return _Replacement(node, f"context.{BEFORE}.{next(iter(known))}")


def _unknown(name: str, measures: Mapping[str, object]) -> tuple[str, str]:
    return f"there is no measure `{name}`", did_you_mean(name, [*measures, BEFORE], "there are")
