"""Expressions as Python text inside a larger function: without a call, and mostly without a Scope.

The text is unparsed from the tree that `builder` makes, so that the user's source appears only as Python literals. If
it raises, `compile_expression` of the same source determines the result.
"""

import ast
from functools import lru_cache
from typing import NamedTuple

from lumen.expressions.builder import CodeBuilder
from lumen.expressions.function_table import all_functions
from lumen.expressions.functions import CAUGHT
from lumen.expressions.parser import parse_expression
from lumen.expressions.tree import ExpressionNode, FieldAccess, FunctionCall, Identifier, walk
from lumen.language.events import Event


class InlinedExpression(NamedTuple):
    """An expression as Python text, in which `context` is a variable."""

    text: str
    needs: frozenset[str]
    """The parts that the variable `scope` must have."""


@lru_cache(maxsize=8192)
def inlined(source: str, event: str, guard: bool) -> InlinedExpression:
    """Return the expression as text; `event` is the name of the Event's variable. For `guard` see `compile_guard`."""
    text = ast.unparse(_InlineBuilder(parse_expression(source), event).result(guard))
    return InlinedExpression(text, scope_needs(source) - {"context", "event"})


@lru_cache(maxsize=8192)
def scope_needs(source: str) -> frozenset[str]:
    """Return the parts of a Scope that an expression needs: root names, `In`, `heard`, else `scope`."""
    return frozenset(need for node, _ in walk(parse_expression(source)) for need in _needs_of(node))


def _needs_of(node: ExpressionNode) -> tuple[str, ...]:
    match node:
        case Identifier(name):
            return (name,)
        case FunctionCall("In"):
            return ("In",)
        case FunctionCall(function) if function == CAUGHT:
            return ("scope", "heard")
        case FunctionCall(function) if all_functions()[function].scoped:
            return ("scope",)
    return ()


class _InlineBuilder(CodeBuilder):
    """Uses variables for the context and the event, and subscripts of the variable `scope` for everything else."""

    def __init__(self, tree: ExpressionNode, event: str) -> None:
        super().__init__(tree, careful=False)
        self.event = ast.Name(event, ast.Load())

    def build(self, node: ExpressionNode) -> ast.expr:
        match node:
            case Identifier("context"):
                return ast.Name("context", ast.Load())
            case FieldAccess(Identifier("event"), "name" | "data" as name):
                return self._field(name)
            case Identifier("event"):
                fields = ("name", "data")
                return ast.Dict([ast.Constant(name) for name in fields], [self._field(name) for name in fields])
        return super().build(node)

    def _field(self, name: str) -> ast.expr:
        return ast.Subscript(self.event, ast.Constant(Event._fields.index(name)), ast.Load())
