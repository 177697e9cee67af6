"""Evaluates ECMAScript's literals."""

from typing import Any

from lumen.expressions.scope import MAX_INT, MIN_INT
from lumen.expressions.tree import ExpressionNode, Identifier, ListLiteral, Literal, MapLiteral


def constant(tree: ExpressionNode, otherwise: Any) -> Any:
    """Return the JSON value of a tree of ECMAScript literals, or `otherwise` if any part must be computed.

    `undefined` becomes None, and an integer outside Lumen's range a float.
    """
    match tree:
        case Literal(value=int() as value) if not isinstance(value, bool) and not MIN_INT <= value <= MAX_INT:
            return float(value)
        case Literal(value=value):
            return value
        case Identifier(name="undefined"):
            return None
        case ListLiteral(items=items):
            found = [constant(item, otherwise) for item in items]
            return otherwise if any(value is otherwise for value in found) else found
        case MapLiteral(keys=keys, values=values):
            table = {key: constant(value, otherwise) for key, value in zip(keys, values, strict=True)}
            return otherwise if any(value is otherwise for value in table.values()) else table
    return otherwise
