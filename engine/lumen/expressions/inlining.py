"""Expressions as text of Python, to stand within a larger function: without a call, and mostly without a Scope.

The text is unparsed from the tree that `builder` makes: what a user wrote stands in it as literals of Python.
Where it raises anything, `compile_expression` of the same source says what that comes to.
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
    """The text, in which `context` is a variable, and what it needs of the variable `scope`."""

    text: str
    needs: frozenset[str]


@lru_cache(maxsize=8192)
def inlined(source: str, event: str, guard: bool) -> InlinedExpression:
    """The expression where the variable of that name holds the Event; as `compile_guard` for a `guard`."""
    text = ast.unparse(_InlineBuilder(parse_expression(source), event).result(guard))
    return InlinedExpression(text, scope_needs(source) - {"context", "event"})


@lru_cache(maxsize=8192)
def scope_needs(source: str) -> frozenset[str]:
    """What a compiled expression needs a Scope for: names it refers to, `In`, `heard`, and `scope` for others."""
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
    """Names the context and the event by variables, and everything else by its place in the variable `scope`."""

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
