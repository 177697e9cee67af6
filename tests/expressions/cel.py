"""Google's CEL as an oracle: the value of an expression there, and the intended differences."""

from collections.abc import Iterator, Mapping
from ctypes import py_object, pythonapi
from math import isfinite
from typing import Any

from cel_expr_python import cel
from cel_expr_python.ext import ext_strings

from lumen.errors import ExpressionError
from lumen.expressions import ExpressionNode, Scope, compile_expression, unparse
from lumen.expressions.tree import Binary, FieldAccess, FunctionCall, SourceSpan, children

ENVIRONMENT = cel.NewEnv(
    variables=dict.fromkeys(("context", "event", "state"), cel.Type.DYN), extensions=[ext_strings.ExtStrings()]
)
NONE = py_object(None)
"""cel-expr-python 0.1.3 hands out None without counting it, which ends in a crash after some thousands."""

METHODS = {"contains": "contains", "replace": "replace", "trim": "trim", "matches": "matches", "lower": "lowerAscii"}

Outcome = tuple[Any, ...]
"""`("value", …)` or `("error",)`."""


def by_lumen(source: str, scope: Scope) -> Outcome:
    try:
        return "value", compile_expression(source)(scope)
    except ExpressionError:
        return ("error",)


def by_cel(source: str, scope: Scope) -> Outcome:
    """Return the outcome in CEL, without its type checker, since lint has that part. RuntimeError if unreadable."""
    data = {"context": scope.context, "event": scope.event, "state": scope.state}
    result = ENVIRONMENT.compile(source, disable_check=True).eval(data=data)
    if result.type().name() == "ERROR":
        return ("error",)
    value = result.plain_value()
    for _ in (leaf for leaf in leaves(value) if leaf is None):
        pythonapi.Py_IncRef(NONE)
    return "value", value


def in_cel(part: Any) -> Any:
    """Return a tree, or a part of one, with CEL's methods in place of our functions."""
    match part:
        case FunctionCall(function=function, arguments=arguments) if function in METHODS:
            return FunctionCall(f".{METHODS[function]}", in_cel(arguments))
        case tuple():
            return tuple(map(in_cel, part))
        case SourceSpan():
            return type(part)(*(in_cel(getattr(part, name)) for name in type(part).__match_args__))
    return part


def same(one: Outcome, other: Outcome) -> bool:
    """Return whether two outcomes are the same; 1, 1.0 and true are three values."""
    return repr(_ordered(one)) == repr(_ordered(other))


def _ordered(value: Any) -> Any:
    match value:
        case Mapping():
            return {key: _ordered(value[key]) for key in sorted(value)}
        case list() | tuple():
            return [_ordered(item) for item in value]
    return value


def compare(node: ExpressionNode, scope: Scope) -> bool:
    """Return whether the expression has the same outcome in both.

    Raises AssertionError if it differs although all parts agree, and it is not in the table of docs/expressions.md.
    """
    alike = not [child for child in children(node) if not compare(child, scope)]
    ours, theirs = by_lumen(unparse(node), scope), by_cel(unparse(in_cel(node)), scope)
    if same(ours, theirs):
        return True
    assert not alike or is_meant(node, scope, ours, theirs), f"{unparse(node)}: {ours}, and {theirs} in CEL"
    return False


def is_meant(node: ExpressionNode, scope: Scope, ours: Outcome, theirs: Outcome) -> bool:
    """Return whether the table lists this difference, which arises in one step from the values of the parts."""
    values = [by_lumen(unparse(child), scope)[1:] for child in children(node)]
    flat = [leaf for value in values for leaf in leaves(list(value))]
    kinds = {type(value) for value in flat}
    match node:
        case Binary(sign="+" | "-" | "*" | "/") if kinds == {int, float}:
            return theirs == ("error",)
        case Binary(sign="%") if float in kinds:
            return theirs == ("error",) and kinds <= {int, float}
        case Binary(sign="+" | "-" | "*" | "/") if kinds == {float}:
            return ours == ("error",) and not isfinite(theirs[1])
        case Binary(sign="==" | "!=" | "<" | "<=" | ">" | ">=" | "in") if "error" not in (*ours, *theirs):
            return kinds >= {int, float} and any(type(v) is int and abs(v) > 2**53 for v in flat)
        case Binary(sign="in") if isinstance(values[1][0], Mapping) and not isinstance(values[0][0], str):
            return theirs == ("error",) and ours == ("value", False)
        case FunctionCall(function="has", arguments=(FieldAccess(base=base),)):
            found = by_lumen(unparse(base), scope)
            return theirs == ("error",) and ours == ("value", False) and not isinstance(found[-1], Mapping)
        case FunctionCall(function="lower"):
            return not flat[0].isascii()
    return False


def leaves(value: Any) -> Iterator[Any]:
    """Yield the values inside lists and maps, or the value itself."""
    match value:
        case Mapping():
            for item in value.values():
                yield from leaves(item)
        case list() | tuple():
            for item in value:
                yield from leaves(item)
        case _:
            yield value
