"""Expressions as functions.

`a && b` becomes Python's `and`, which has CEL's meaning unless an operand fails. If an operand fails, the expression is
evaluated again by CEL's full rule: `a && b` is false if either operand is false, even if the other has no value.
"""

from collections.abc import Callable, Sequence
from functools import cache, lru_cache
from types import CodeType
from typing import Any

from lumen.expressions import operators as values
from lumen.expressions.builder import OPERATOR_FUNCTIONS, CodeBuilder
from lumen.expressions.checker import must_hold
from lumen.expressions.error_explanation import explain
from lumen.expressions.function_table import all_functions
from lumen.expressions.parser import parse_expression
from lumen.expressions.scope import Scope
from lumen.expressions.tree import ExpressionNode, Logic, walk

Evaluate = Callable[[Scope], Any]


def both(*operands: Callable[[], Any]) -> bool:
    """Return CEL's `&&` of operands, which are called in order: False if any is False, else True.

    Raises the first error of an operand if no operand is False.
    """
    return not _any_is(False, operands)


def either(*operands: Callable[[], Any]) -> bool:
    """Return CEL's `||` of operands, which are called in order: True if any is True, else False.

    Raises the first error of an operand if no operand is True.
    """
    return _any_is(True, operands)


def _any_is(decisive: bool, operands: Sequence[Callable[[], Any]]) -> bool:
    fault: Exception | None = None
    for operand in operands:
        try:
            if operand() is decisive:
                return True
        except Exception as error:
            fault = fault or error
    if fault:
        raise fault
    return False


_HELPERS = [*OPERATOR_FUNCTIONS.values(), "truth", "negation", "negative", "item", "has", "bounded"]


@cache
def code_names() -> dict[str, Any]:
    """Return all names that compiled code of expressions can use, with their values; Python's built-ins are absent."""
    return (
        {name: getattr(values, name) for name in _HELPERS}
        | {f"call_{name}": function.call for name, function in all_functions().items()}
        | {"type": type, "map": dict, "numbers": frozenset((int, float)), "whole": int}
        | {"both": both, "either": either, "__builtins__": {}}
    )


@lru_cache(maxsize=8192)
def compile_expression(source: str) -> Evaluate:
    """Return the expression as a pure function of a Scope; equal sources give the same function while it is cached.

    Raises ExpressionError if the source is invalid; the function raises it if the expression has no value.
    """
    return _compile(source, guard=False)


@lru_cache(maxsize=8192)
def compile_guard(source: str) -> Callable[[Scope], bool]:
    """Return the expression as a condition: like `compile_expression`, but any value except a boolean is an error."""
    return _compile(source, guard=True)


def _compile(source: str, *, guard: bool) -> Evaluate:
    tree = parse_expression(source)
    must_hold(tree)
    careful: list[Evaluate] = []
    logical = any(isinstance(node, Logic) for node, _ in walk(tree))

    def failed(error: Exception, scope: Scope) -> Any:
        """Return the value by CEL's full rule if the expression has `&&` or `||`; else raise the error, explained."""
        if not logical:
            raise explain(error, source, tree, scope) from None
        if not careful:
            careful.append(_function(CodeBuilder(tree, careful=True).code(guard), _explainer(source, tree)))
        return careful[0](scope)

    return _function(CodeBuilder(tree, careful=False).code(guard), failed)


def _explainer(source: str, tree: ExpressionNode) -> Callable[[Exception, Scope], Any]:
    def failed(error: Exception, scope: Scope) -> Any:
        raise explain(error, source, tree, scope) from None

    return failed


def _function(code: CodeType, failed: Callable[[Exception, Scope], Any]) -> Evaluate:
    names = {**code_names(), "failed": failed, "Exception": Exception}
    exec(code, names)
    evaluate: Evaluate = names["evaluate"]
    return evaluate
