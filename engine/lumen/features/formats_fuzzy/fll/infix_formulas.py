"""Translates formulas between FuzzyLite's infix notation and Lumen's, whose operators differ.

In FuzzyLite, `^` and `**` are powers, `~` and `.-` minus signs, `and` and `or` logical operators, and functions such as
`lt(a, b)` comparisons.
"""

import re
from collections.abc import Mapping
from typing import ClassVar, NamedTuple

from lumen.errors import ExpressionError
from lumen.expressions import ExpressionNode, parse_expression, unparse
from lumen.expressions.pratt import PrattParser
from lumen.expressions.tokens import Token
from lumen.expressions.tree import Binary, Conditional, FunctionCall, Identifier, Literal, Logic, Unary
from lumen.fuzzy.formulas import FORMULA_FUNCTIONS

_TOKEN = re.compile(
    r"\s*(?:(?P<number>(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)|(?P<name>[A-Za-z_][\w.]*)"
    r"|(?P<sign>\*\*|\.\+|\.-|[-+*/%^!~(),]))"
)
_COMPARISONS = {"lt": "<", "le": "<=", "eq": "==", "neq": "!=", "ge": ">=", "gt": ">"}
MAX_FORMULA_LEVELS = 40
"""The deepest nesting of brackets, arguments and signs in a formula."""


class Trouble(NamedTuple):
    """The reason why a formula can't be read, and the character index of the problem."""

    message: str
    offset: int


def read_formula(text: str, names: Mapping[str, str]) -> str | Trouble:
    """Translate a FuzzyLite formula to Lumen's, or return the problem in it; `names` maps variables to Lumen's."""
    try:
        return unparse(_FormulaParser(text, names).whole())
    except ExpressionError as error:
        return Trouble(error.message, error.offset)


def _tokens(text: str) -> list[Token]:
    tokens, offset = [], 0
    while offset < len(text.rstrip()):
        match = _TOKEN.match(text, offset)
        if not match or not match.lastgroup:
            raise ExpressionError(f"`{text[offset:].strip()[:1]}` is unexpected", offset)
        tokens.append(Token(match.lastgroup, match[match.lastgroup], match.start(match.lastgroup)))
        offset = match.end()
    return [*tokens, Token("end", "", len(text))]


class _FormulaParser(PrattParser):
    """Parses FuzzyLite's formulas, with FuzzyLite's operator precedence."""

    max_levels = MAX_FORMULA_LEVELS

    def __init__(self, text: str, names: Mapping[str, str]) -> None:
        super().__init__(_tokens(text))
        self.names = names

    def unexpected(self, hint: str = "") -> ExpressionError:
        text = self.token.text
        return ExpressionError(f"`{text}` is unexpected" if text else "it ends unexpectedly", self.token.offset)

    def too_deep(self, offset: int) -> ExpressionError:
        return ExpressionError("it is nested too deeply", offset)

    def number(self) -> ExpressionNode:
        token = self.advance()
        value = float(token.text)
        if value == float("inf"):
            raise ExpressionError(f"the number `{token.text}` is too large", token.offset)
        return Literal(int(value) if value == int(value) and abs(value) < 1e15 else value)

    def minus(self, power: int) -> ExpressionNode:
        self.advance()
        return Unary("-", self.expression(power))

    def plus(self, power: int) -> ExpressionNode:
        self.advance()
        return self.expression(power)

    def name(self) -> ExpressionNode:
        text, offset = self.advance()[1:3]
        if not self.accept("("):
            if text not in self.names and text not in ("x", "pi"):
                raise ExpressionError(f"unknown name `{text}`", offset)
            return Identifier(self.names.get(text, text))
        arguments, _ = self.listed(")")
        if text == "pi" and not arguments:
            return Identifier("pi")
        if text in _COMPARISONS and len(arguments) == 2:
            return Binary(_COMPARISONS[text], *arguments)
        function = {"fabs": "abs"}.get(text, text)
        if FORMULA_FUNCTIONS.get(function) != len(arguments):
            few = f"{len(arguments)} argument{'s' * (len(arguments) != 1)}"
            raise ExpressionError(f"there is no function `{text}` with {few}", offset)
        return FunctionCall(function, arguments)

    def joined(self, left: ExpressionNode, sign: Token, power: int) -> ExpressionNode:
        """Return `left and right` or `left or right`."""
        return Logic("&&" if sign.text == "and" else "||", (left, self.expression(power)))

    def raised(self, left: ExpressionNode, sign: Token, power: int) -> ExpressionNode:
        """Return `left ^ right`, which is right-associative."""
        return FunctionCall("pow", (left, self.expression(power - 1)))

    operands: ClassVar = {"number": number, "name": name}
    prefixes: ClassVar = {
        **dict.fromkeys(("-", "~", ".-"), (5, minus)),
        **dict.fromkeys(("+", ".+"), (5, plus)),
        "!": (7, PrattParser.unary),
        "(": (0, PrattParser.group),
    }
    infixes: ClassVar = {
        "or": (1, joined),
        "and": (2, joined),
        **dict.fromkeys(("+", "-"), (3, PrattParser.binary)),
        **dict.fromkeys(("*", "/", "%"), (4, PrattParser.binary)),
        **dict.fromkeys(("^", "**"), (6, raised)),
    }


def write_formula(text: str, names: Mapping[str, str]) -> tuple[str, bool]:
    """Translate a Lumen formula to FuzzyLite's; also return whether it contains a conditional, written as a sum."""
    tree = parse_expression(text)
    writer = _FormulaWriter(names)
    return writer.text(tree), writer.chose


class _FormulaWriter:
    def __init__(self, names: Mapping[str, str]) -> None:
        self.names, self.chose = names, False

    def text(self, node: ExpressionNode) -> str:
        match node:
            case Literal(value):
                return repr(value)
            case Identifier(name):
                return "pi()" if name == "pi" and name not in self.names else self.names.get(name, name)
            case Unary(sign, operand):
                return f"{'~' if sign == '-' else '!'}({self.text(operand)})"
            case Binary(sign, left, right) if sign in _COMPARISONS.values():
                function = next(name for name, word in _COMPARISONS.items() if word == sign)
                return f"{function}({self.text(left)}, {self.text(right)})"
            case Binary(sign, left, right):
                return f"{self.inner(left)} {sign} {self.inner(right)}"
            case Logic(sign, operands):
                return f" {'and' if sign == '&&' else 'or'} ".join(map(self.inner, operands))
            case Conditional(condition, then, otherwise):
                self.chose = True
                asked = self.text(condition)
                return f"({asked}) * ({self.text(then)}) + !({asked}) * ({self.text(otherwise)})"
            case FunctionCall(function, arguments):
                return f"{function}({', '.join(map(self.text, arguments))})"
        raise AssertionError(f"not a part of a formula: {node}")

    def inner(self, node: ExpressionNode) -> str:
        compared = isinstance(node, Binary) and node.sign in _COMPARISONS.values()
        bare = compared or not isinstance(node, Unary | Binary | Logic | Conditional)
        return self.text(node) if bare else f"({self.text(node)})"
