"""The values that an expression read, to explain why it was true or false."""

import re
from collections.abc import Iterator
from typing import Any

from lumen.errors import ExpressionError
from lumen.expressions.compiler import compile_expression
from lumen.expressions.functions import CAUGHT
from lumen.expressions.parser import parse_expression
from lumen.expressions.printer import unparse
from lumen.expressions.scope import Scope
from lumen.expressions.tree import (
    ExpressionNode,
    FieldAccess,
    FunctionCall,
    IndexAccess,
    Literal,
    children,
    path_of,
)

_CAUGHT = re.compile(rf"\b{CAUGHT}\(\d+\)")
_LOCALIZED = re.compile(r"\bin_language\((heard(?:\.\w+|\['\w+'\])*)\)")


def readings(source: str, scope: Scope, shown: str = "") -> dict[str, Any]:
    """Return the values of the expression's paths and of functions such as `hour()` and `In('dance')`.

    Keys are the parts as the author wrote them. `shown` is the author's text if it differs from `source`; parts that it
    lacks are left out. Parts without a value are left out too, such as a missing field in `has(event.data.name)`.
    """
    found: dict[str, Any] = {}
    for node in _looked_at(parse_expression(source)):
        text = unparse(node)
        written = as_written(text)
        if written in (shown or source).replace('"', "'"):
            try:
                found[written] = compile_expression(text)(scope)
            except ExpressionError:
                continue
    return found


def as_written(source: str) -> str:
    """Return an expression of a row of `hears` as its author wrote it, with `heard` for the engine's own function."""
    return _LOCALIZED.sub(r"\1", _CAUGHT.sub("heard", source)) if CAUGHT in source else source


def looks_at_what_was_heard(node: ExpressionNode) -> bool:
    """Return whether the node is `heard` of a row of `hears`, or a field or element in it."""
    while isinstance(node, FieldAccess | IndexAccess):
        node = node.base
    return isinstance(node, FunctionCall) and node.function == CAUGHT


def _looked_at(node: ExpressionNode) -> Iterator[ExpressionNode]:
    constant = isinstance(node, FunctionCall) and all(isinstance(one, Literal) for one in node.arguments)
    if path_of(node) or constant or looks_at_what_was_heard(node):
        yield node
        return
    for child in children(node):
        yield from _looked_at(child)
