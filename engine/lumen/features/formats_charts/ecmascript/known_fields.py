"""The fields of an event that are known to be present: ECMAScript's undefined is a missing field in Lumen."""

from lumen.expressions.tree import Binary, ExpressionNode, FunctionCall, Literal, Logic, Unary, path_of


def negated(node: ExpressionNode) -> ExpressionNode:
    """Return the negation, without a needless `!`."""
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
    """Return whether a path leads to a field of the event's data."""
    return path is not None and path[:2] == ("event", "data") and len(path) > 2


def known(node: ExpressionNode, holds: bool) -> frozenset[tuple[str, ...]]:
    """Return the fields that are present if the node holds (or does not hold)."""
    match node:
        case FunctionCall(function="has", arguments=(target,)) if holds:
            path = path_of(target)
            return frozenset((path,)) if path else frozenset()
        case Unary(sign="!", operand=operand):
            return known(operand, not holds)
        case Logic(sign=sign, operands=operands) if holds == (sign == "&&"):
            return frozenset().union(*(known(operand, holds) for operand in operands))
    return frozenset()
