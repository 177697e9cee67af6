"""Converts computed values for other XState tools: literals to their values, other expressions to text."""

from collections.abc import Mapping, Sequence
from typing import Any

from lumen.expressions import ExpressionError, parse_expression
from lumen.expressions.readings import as_written
from lumen.expressions.tree import Literal
from lumen.language.actions import ComputedValue, Expression


def constant(value: ComputedValue) -> Any:
    """Return a computed value as data, with the value of each literal and the source of any other expression."""
    match value:
        case Expression(source):
            return _text(source)
        case tuple():
            return [constant(item) for item in value]
        case Mapping():
            return {key: constant(item) for key, item in value.items()}
    return value


def constant_data(data: Any) -> Any:
    """Convert a value of a behaviour file like `constant`. Its texts are expressions; invalid ones stay texts."""
    match data:
        case str():
            return _text(data)
        case Mapping():
            return {key: constant_data(item) for key, item in data.items()}
        case Sequence():
            return [constant_data(item) for item in data]
    return data


def _text(source: str) -> Any:
    try:
        tree = parse_expression(source)
    except ExpressionError:
        return source
    return tree.value if isinstance(tree, Literal) else as_written(source)
