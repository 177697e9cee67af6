"""Check the formula of a `function` term: its syntax and each name, function and number in it."""

from collections.abc import Sequence

from lumen.errors import ExpressionError
from lumen.expressions import parse_expression
from lumen.expressions.expression_findings import (
    EXPRESSION_SYNTAX,
    TYPE_MISMATCH,
    UNKNOWN_FUNCTION,
    UNKNOWN_NAME,
    WRONG_ARGUMENT_COUNT,
)
from lumen.expressions.tree import (
    Binary,
    Conditional,
    ExpressionNode,
    FunctionCall,
    Identifier,
    Literal,
    Logic,
    Unary,
    walk,
)
from lumen.fuzzy.formulas import FORMULA_FUNCTIONS
from lumen.language.diagnostics import Code, NodePath, did_you_mean
from lumen.language.numbers import is_number
from lumen.project.document_report import DocumentReport
from lumen.project.word_places import report_word

_PLAIN = (Identifier, Unary, Logic, Conditional)


def check_formula(text: str, names: Sequence[str], report: DocumentReport, path: NodePath) -> bool:
    """Return True if the text at `path` is a formula of x and the variables called `names`; report what is wrong."""
    try:
        tree = parse_expression(text)
    except ExpressionError as error:
        report_word(report, EXPRESSION_SYNTAX, path, text, error.offset, 1, error.message, error.hint)
        return False
    found = [_sound(node, text, names, report, path) for node, _ in walk(tree)]
    return all(found)


def _sound(node: ExpressionNode, text: str, names: Sequence[str], report: DocumentReport, path: NodePath) -> bool:
    def refuse(code: Code, offset: int, length: int, message: str, hint: str) -> bool:
        report_word(report, code, path, text, offset, length, message, hint)
        return False

    match node:
        case Identifier(name) if name not in (*names, "x", "pi"):
            hint = did_you_mean(name, ("x", "pi", *names), "available:")
            return refuse(UNKNOWN_NAME, node.offset, len(name), f"a formula has no variable `{name}`", hint)
        case FunctionCall(name) if name not in FORMULA_FUNCTIONS:
            hint = did_you_mean(name, FORMULA_FUNCTIONS, "the functions are")
            return refuse(UNKNOWN_FUNCTION, node.named, len(name), f"a formula has no function `{name}`", hint)
        case FunctionCall(name, arguments) if len(arguments) != FORMULA_FUNCTIONS[name]:
            wanted = FORMULA_FUNCTIONS[name]
            message = f"`{name}` has {len(arguments)} argument{'s' * (len(arguments) != 1)}, but needs {wanted}"
            hint = f"write {name}({', '.join('ab'[:wanted])})"
            return refuse(WRONG_ARGUMENT_COUNT, node.named, len(name), message, hint)
        case Literal(value) if not is_number(value):
            length = node.end - node.offset
            return refuse(TYPE_MISMATCH, node.offset, length, "a formula can only contain numbers", "write a number")
        case Binary("in"):
            return refuse(TYPE_MISMATCH, node.offset, 1, "a formula can't contain lists", "compare with `==`")
        case FunctionCall() | Literal() | Binary():
            return True
    if not isinstance(node, _PLAIN):
        return refuse(TYPE_MISMATCH, node.offset, 1, "a formula can't contain lists or fields", "use numbers alone")
    return True
