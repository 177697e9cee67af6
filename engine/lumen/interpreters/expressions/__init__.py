"""The expression language: a typed subset of CEL for guards, `assign` values and `{{ … }}` in texts.

evaluate = compile_expression("context.asked < 3 && has(event.data.result)")
evaluate(Scope(context={"asked": 1}, event={"name": "heard", "data": {"result": "hi"}}))     # True
"""

from lumen.errors import ExpressionError
from lumen.interpreters.expressions.checker import check_expression
from lumen.interpreters.expressions.compiler import compile_expression, compile_guard
from lumen.interpreters.expressions.findings import Finding
from lumen.interpreters.expressions.parser import parse_expression
from lumen.interpreters.expressions.printer import unparse
from lumen.interpreters.expressions.schemas import schema_of
from lumen.interpreters.expressions.scope import Scope
from lumen.interpreters.expressions.templates import check_template, compile_template, split_template
from lumen.interpreters.expressions.tree import Names, Node, names

__all__ = [
    "ExpressionError",
    "Finding",
    "Names",
    "Node",
    "Scope",
    "check_expression",
    "check_template",
    "compile_expression",
    "compile_guard",
    "compile_template",
    "names",
    "parse_expression",
    "schema_of",
    "split_template",
    "unparse",
]
