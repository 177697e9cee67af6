"""Values at which the result of a guard changes, derived from the guard itself."""

from collections.abc import Iterable, Iterator, Mapping
from typing import Any

from lumen.expressions import ExpressionError, Scope, compile_expression, parse_expression, unparse
from lumen.expressions.tree import (
    Binary,
    ExpressionNode,
    FunctionCall,
    ListLiteral,
    Literal,
    children,
    path_of,
    walk,
)
from lumen.insight.exploration.samples import SAMPLE_TEXT, phrases_at, texts_for
from lumen.language.machines import MachineDefinition

ValuePath = tuple[str, ...]
"""The keys that lead to a value: `("context", "tries")`, `("event", "data", "result")`."""
ABSENT = object()
"""The value that `value_at` returns for a path that does not exist."""
MAX_VALUES = 24
"""The maximum number of values that are tried for one path."""
FIRST = 6
"""The number of values from the guard that are tried before plain values; the remaining values are tried after."""


def boundaries(machine: MachineDefinition, sources: Iterable[str], scope: Scope) -> dict[ValuePath, list[Any]]:
    """Return values that may change a guard, for each path of the context and the event's data that guards read.

    Numbers nearest to the present value come first.
    """
    found: dict[ValuePath, list[Any]] = {}
    trees = [parse_expression(source) for source in sources]
    for tree in trees:
        for path, value in _mentioned(machine, tree, scope):
            found.setdefault(path, []).append(value)
    literals = [n.value for tree in trees for n, _ in walk(tree) if isinstance(n, Literal)]
    return {
        path: _nearest(path, [*values[:FIRST], *_plain(value_at(path, scope)), *values[FIRST:], *literals], scope)
        for path, values in found.items()
    }


def value_at(path: ValuePath, scope: Scope) -> Any:
    """Return the value at a path; ABSENT if the path does not exist."""
    value: Any = {"context": scope.context, "event": scope.event}
    for key in path:
        if not isinstance(value, Mapping) or key not in value:
            return ABSENT
        value = value[key]
    return value


def _nearest(path: ValuePath, values: Iterable[Any], scope: Scope) -> list[Any]:
    """Return the distinct values of the present value's kind, without that value; numbers by their distance from it.

    At most MAX_VALUES are returned. If there is no present value, or it is None, values of all kinds are returned.
    """
    now = value_at(path, scope)
    fitting = [v for v in values if v is not ABSENT and (now is ABSENT or now is None or _kind(v) == _kind(now))]
    unique = list({repr(v): v for v in fitting if now is ABSENT or not _same(v, now)}.values())
    if _kind(now) == "number":
        unique.sort(key=lambda v: abs(v - now))
    return unique[:MAX_VALUES]


def _same(one: Any, other: Any) -> bool:
    return type(one) is type(other) and bool(one == other)


def _kind(value: Any) -> str:
    if isinstance(value, bool):
        return "boolean"
    return "number" if isinstance(value, int | float) else type(value).__name__


def _plain(now: Any) -> list[Any]:
    """Return a few values of the present value's kind; without a value, a few of each kind."""
    match now:
        case bool():
            return [not now]
        case int() | float():
            return [now + 1, now - 1, 0, 1, 2, now - 5, now + 5, now - 10]
        case str():
            return [SAMPLE_TEXT, ""]
        case list():
            return [[], [*now, SAMPLE_TEXT]]
    return [1, 0, 2, SAMPLE_TEXT, "", True, False]


def _mentioned(machine: MachineDefinition, tree: ExpressionNode, scope: Scope) -> Iterator[tuple[ValuePath, Any]]:
    for node, _ in walk(tree):
        if path := _changeable(node):
            yield path, ABSENT
        match node:
            case FunctionCall(function=function, arguments=(first, Literal(value=str() as text))):
                yield from ((p, value) for value in texts_for(machine, function, text) for p in _paths(first))
            case FunctionCall(function="heard", arguments=(first, second)):
                texts = phrases_at(path_of(second), scope.context)
                yield from ((p, value) for value in texts for p in _paths(first))
            case Binary(sign=sign, left=left, right=right):
                for one, other in ((left, right), (right, left)):
                    yield from _compared(sign, one, other, scope)


def _compared(sign: str, one: ExpressionNode, other: ExpressionNode, scope: Scope) -> Iterator[tuple[ValuePath, Any]]:
    """Yield values of the paths in `one` that make `one` equal, or nearly equal, to `other`."""
    paths = list(_paths(one))
    if not paths:
        return
    items = other.items if sign == "in" and isinstance(other, ListLiteral) else (other,)
    for item in items:
        goal = _value(item, scope)
        if _kind(goal) == "number":
            yield from _numbers(one, paths, goal, scope)
        elif goal is not ABSENT:
            yield from ((path, goal) for path in paths)
            if sign == "in" and isinstance(goal, list | dict):
                yield from ((path, element) for element in [*goal][:10] for path in paths)


def _numbers(one: ExpressionNode, paths: list[ValuePath], goal: Any, scope: Scope) -> Iterator[tuple[ValuePath, Any]]:
    now = _value(one, scope)
    for path in paths:
        value = value_at(path, scope)
        if _kind(value) == "number" and _kind(now) == "number":
            for far in (goal - now, now - goal):
                yield from ((path, value + far + beside) for beside in (0, 1, -1))
        elif isinstance(value, str) and isinstance(goal, int) and 0 <= goal < 50:
            yield from ((path, " ".join([SAMPLE_TEXT] * n)) for n in (goal, goal + 1))
            yield from ((path, "x" * n) for n in (goal, goal + 1, goal - 1) if n >= 0)
        else:
            yield from ((path, goal + beside) for beside in (0, 1, -1))


def _paths(tree: ExpressionNode) -> Iterator[ValuePath]:
    if path := _changeable(tree):
        yield path
        return
    for child in children(tree):
        yield from _paths(child)


def _changeable(node: ExpressionNode) -> ValuePath | None:
    path = path_of(node)
    return path if path and (path[:2] == ("event", "data") or (path[0] == "context" and len(path) > 1)) else None


def _value(node: ExpressionNode, scope: Scope) -> Any:
    try:
        return compile_expression(unparse(node))(scope)
    except ExpressionError:
        return ABSENT
