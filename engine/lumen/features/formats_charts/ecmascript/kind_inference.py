"""Infers the kind of an expression's value, and the event fields that must be present."""

from collections.abc import Mapping
from typing import Any

from lumen.expressions.function_table import functions
from lumen.expressions.kinds import BOOLEAN, LIST, MAP, NUMBER, TEXT, kind_of
from lumen.expressions.tree import (
    Binary,
    Conditional,
    ExpressionNode,
    FunctionCall,
    ListLiteral,
    Literal,
    Logic,
    MapLiteral,
    Unary,
    path_of,
)


def negated(node: ExpressionNode) -> ExpressionNode:
    """Return the negated expression, without `!` if a simpler form exists."""
    match node:
        case Unary(sign="!", operand=operand):
            return operand
        case Literal(value=bool() as value):
            return Literal(not value)
        case Binary(sign="==" | "!=" as sign, left=left, right=right):
            return Binary("!=" if sign == "==" else "==", left, right)
        case Logic(sign="&&", operands=(FunctionCall(function="has"), *_)):
            return Logic("||", tuple(negated(operand) for operand in node.operands))
    return Unary("!", node)


def is_data(path: tuple[str, ...] | None) -> bool:
    """Return whether a path names a field in the event's data; False for None."""
    return path is not None and path[:2] == ("event", "data") and len(path) > 2


def known(node: ExpressionNode, holds: bool) -> frozenset[tuple[str, ...]]:
    """Return the paths of the fields that must be present if the node's value is `holds`."""
    match node:
        case FunctionCall(function="has", arguments=(target,)) if holds:
            path = path_of(target)
            return frozenset((path,)) if path else frozenset()
        case Unary(sign="!", operand=operand):
            return known(operand, not holds)
        case Logic(sign=sign, operands=operands) if holds == (sign == "&&"):
            return frozenset().union(*(known(operand, holds) for operand in operands))
    return frozenset()


UNKNOWN_KIND = ""


def kind(node: ExpressionNode, context: Mapping[str, str]) -> str:
    """Return the kind of a Lumen expression's value, or UNKNOWN_KIND; `context` maps keys to constant kinds."""
    match node:
        case Literal(value=value):
            return kind_of(value)
        case Logic() | Unary(sign="!"):
            return BOOLEAN
        case Unary():
            return NUMBER
        case ListLiteral():
            return LIST
        case MapLiteral():
            return MAP
        case Binary(sign="+", left=left, right=right):
            return kind(left, context) or kind(right, context)
        case Binary(sign="-" | "*" | "/" | "%"):
            return NUMBER
        case Binary():
            return BOOLEAN
        case Conditional(then=then, otherwise=otherwise):
            found = {kind(then, context), kind(otherwise, context)}
            return found.pop() if len(found) == 1 else UNKNOWN_KIND
        case FunctionCall(function=function):
            returns = functions()[function].returns if function in functions() else ()
            return next(iter(returns)) if len(returns) == 1 else UNKNOWN_KIND
    match path_of(node):
        case ("context", key):
            return context.get(key, UNKNOWN_KIND)
        case ("event", "name"):
            return TEXT
    return UNKNOWN_KIND


def is_float(node: ExpressionNode) -> bool:
    """Return whether an expression is certainly a float, for which `/` keeps the fraction."""
    match node:
        case Literal(value=value):
            return isinstance(value, float)
        case Unary(sign="-", operand=operand):
            return is_float(operand)
        case Binary(sign="+" | "-" | "*" | "/", left=left, right=right):
            return is_float(left) or is_float(right)
    return False


def kinds_of(context: Mapping[str, Any], types: Mapping[str, Any]) -> dict[str, str]:
    """Return the kinds of the context keys' first values, without keys that are None or in `types`."""
    return {key: kind_of(value) for key, value in context.items() if value is not None and key not in types}
