"""The expression language: a typed subset of CEL for guards, `assign` values and `{{ … }}` in texts.

evaluate = compile_expression("context.asked < 3 && has(event.data.result)")
evaluate(Scope(context={"asked": 1}, event={"name": "heard", "data": {"result": "hi"}}))     # True
"""

from lumen.errors import ExpressionError
from lumen.expressions.checker import check_expression
from lumen.expressions.compiler import compile_expression, compile_guard
from lumen.expressions.expression_findings import ExpressionFinding
from lumen.expressions.parser import parse_expression
from lumen.expressions.printer import unparse
from lumen.expressions.scope import Scope
from lumen.expressions.substitution import substituted, substituted_template
from lumen.expressions.templates import check_template, compile_template, split_template
from lumen.expressions.tree import ExpressionNode, MentionedNames, names
from lumen.expressions.value_types import schema_of

__all__ = [
    "ExpressionError",
    "ExpressionFinding",
    "ExpressionNode",
    "MentionedNames",
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
    "substituted",
    "substituted_template",
    "unparse",
]
