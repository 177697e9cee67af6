"""Functions of a project in expressions: calls are replaced by the function's expression before anything is compiled.

The compiled code is therefore the same as if the author had written the expression at the place of the call.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from lumen.errors import ExpressionError
from lumen.expressions.parser import parse_expression
from lumen.expressions.printer import unparse
from lumen.expressions.scope import MAX_EXPRESSION_LENGTH, MAX_TREE_DEPTH
from lumen.expressions.tree import (
    ExpressionNode,
    FunctionCall,
    Identifier,
    ListLiteral,
    Literal,
    MapLiteral,
    children,
    rebuilt,
    walk,
)


@dataclass(frozen=True)
class OwnFunction:
    """A function of a project."""

    parameters: Mapping[str, frozenset[str]]
    """The kinds that each argument may have, by the argument's name."""
    returns: frozenset[str]
    """The kinds that the value may have."""
    body: ExpressionNode
    """The expression that replaces a call; it has no calls of other functions of the project."""


KnownFunctions = Mapping[str, OwnFunction | None]
"""The functions of a project by name; None for a function whose file is broken."""


class BrokenFunctionError(Exception):
    """An expression calls a function whose file is broken; that file has the finding."""


def called(tree: ExpressionNode, functions: KnownFunctions) -> list[FunctionCall]:
    """Return the calls of these functions in a tree."""
    return [node for node, _ in walk(tree) if isinstance(node, FunctionCall) and node.function in functions]


def expanded(source: str, functions: KnownFunctions) -> str:
    """Return the source with each call of these functions replaced; without a call, the same source.

    Raises BrokenFunctionError for a call of a broken function, ExpressionError if the result is longer or deeper than
    an expression may be. The source must be valid: each call has the right number of arguments.
    """
    if not any(name in source for name in functions) or not (calls := called(parse_expression(source), functions)):
        return source
    text = unparse(expanded_tree(parse_expression(source), functions))
    try:
        parse_expression(text)
    except ExpressionError as error:
        raise _too_large(calls[0]) from error
    return text


def expanded_tree(tree: ExpressionNode, functions: KnownFunctions) -> ExpressionNode:
    """Return the tree with each call of these functions replaced; raise the same errors as `expanded`."""
    return _Expansion(functions).of(tree)


class _Expansion:
    """Replaces calls from the inside out.

    An argument that a function uses several times is one object in the tree. Therefore even a tree that would be much
    too large is small in memory, and is refused before anything walks through it.
    """

    def __init__(self, functions: KnownFunctions) -> None:
        self.functions = functions
        self.measured: dict[int, tuple[ExpressionNode, int, int]] = {}
        """By the id of a node: the node, which keeps the id in use, and its number of nodes and of levels."""

    def of(self, node: ExpressionNode) -> ExpressionNode:
        node = rebuilt(node, self.of)
        if not isinstance(node, FunctionCall) or node.function not in self.functions:
            return node
        function = self.functions[node.function]
        if function is None:
            raise BrokenFunctionError(node.function)
        replaced = with_arguments(function.body, dict(zip(function.parameters, node.arguments, strict=True)))
        size, levels = self.measure(replaced)
        if size > MAX_EXPRESSION_LENGTH or levels > MAX_TREE_DEPTH:
            raise _too_large(node)
        return replaced

    def measure(self, node: ExpressionNode) -> tuple[int, int]:
        """Return the number of nodes and of levels of a tree."""
        if (known := self.measured.get(id(node))) is None:
            inner = [self.measure(child) for child in children(node)]
            size, levels = 1 + sum(size for size, _ in inner), 1 + max((levels for _, levels in inner), default=0)
            known = self.measured[id(node)] = node, size, levels
        return known[1:]


def _too_large(call: FunctionCall) -> ExpressionError:
    bounds = f"{MAX_EXPRESSION_LENGTH:,} characters or {MAX_TREE_DEPTH} levels"
    hint = "assign a part of it to a key of the context first, and use that key"
    return ExpressionError(f"with `{call.function}` put in, the expression has more than {bounds}", call.named, hint)


def with_arguments(body: ExpressionNode, arguments: Mapping[str, ExpressionNode]) -> ExpressionNode:
    """Return the tree with each name of an argument replaced by the value of that name."""
    if isinstance(body, Identifier):
        return arguments.get(body.name, body)
    return rebuilt(body, lambda child: with_arguments(child, arguments))


def literal(value: Any) -> ExpressionNode:
    """Return the tree of a JSON value. Raises TypeError for any other value."""
    match value:
        case None | bool() | int() | float() | str():
            return Literal(value)
        case list() | tuple():
            return ListLiteral(tuple(map(literal, value)))
        case Mapping():
            return MapLiteral(tuple(map(str, value)), tuple(map(literal, value.values())))
    raise TypeError(f"{type(value).__name__} is not JSON data")
