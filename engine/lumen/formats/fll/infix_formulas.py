"""Formulas: FuzzyLite's infix notation and ours, which are the same sums in other signs.

There `^` and `**` are powers, `~`, `.-` a minus, `and` and `or` logic, `lt(a, b)` and its like comparisons.
"""

import re
from collections.abc import Mapping
from typing import NamedTuple

from lumen.errors import ExpressionError
from lumen.interpreters.expressions import ExpressionNode, parse_expression, unparse
from lumen.interpreters.expressions.tree import Binary, Conditional, FunctionCall, Identifier, Literal, Logic, Unary
from lumen.interpreters.inference.formulas import FORMULA_FUNCTIONS

_TOKEN = re.compile(
    r"\s*(?:(?P<number>(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)|(?P<name>[A-Za-z_][\w.]*)"
    r"|(?P<sign>\*\*|\.\+|\.-|[-+*/%^!~(),]))"
)
_COMPARISONS = {"lt": "<", "le": "<=", "eq": "==", "neq": "!=", "ge": ">=", "gt": ">"}
_POWERS = {"or": 1, "and": 2, "+": 3, "-": 3, "*": 4, "/": 4, "%": 4, "^": 6, "**": 6}
_UNARY = 5
MAX_FORMULA_DEPTH = 40


class Trouble(NamedTuple):
    """Why a formula can't be read, and at which character."""

    message: str
    offset: int


def read_formula(text: str, names: Mapping[str, str]) -> str | Trouble:
    """FuzzyLite's formula as ours; `names` says what its variables are called here."""
    try:
        return unparse(_Parser(text, names).whole())
    except ExpressionError as error:
        return Trouble(error.message, error.offset)


class _Parser:
    """Climbs operator precedence, as FuzzyLite's table gives it."""

    def __init__(self, text: str, names: Mapping[str, str]) -> None:
        self.names, self.text, self.level = names, text, 0
        self.tokens: list[tuple[str, str, int]] = []
        offset = 0
        while offset < len(text.rstrip()):
            match = _TOKEN.match(text, offset)
            if not match or not match.lastgroup:
                raise ExpressionError(f"`{text[offset:].strip()[:1]}` has no meaning", offset)
            self.tokens.append((match.lastgroup, match[match.lastgroup], match.start(match.lastgroup)))
            offset = match.end()
        self.tokens.append(("end", "", len(text)))
        self.next = 0

    def whole(self) -> ExpressionNode:
        node = self.expression(0)
        self.expect("")
        return node

    def expect(self, text: str) -> None:
        _, found, offset = self.tokens[self.next]
        if found != text:
            raise ExpressionError(f"`{found}` can't stand here" if found else "it ends too early", offset)
        self.next += 1

    def expression(self, power: int) -> ExpressionNode:
        self.level += 1
        if self.level > MAX_FORMULA_DEPTH:
            raise ExpressionError("it is nested too deeply", self.tokens[self.next][2])
        left = self.prefix()
        while (stronger := _POWERS.get(self.tokens[self.next][1], 0)) > power:
            sign = self.tokens[self.next][1]
            self.next += 1
            right = self.expression(stronger - 1 if sign in ("^", "**") else stronger)
            left = _joined(sign, left, right)
        self.level -= 1
        return left

    def prefix(self) -> ExpressionNode:
        kind, text, offset = self.tokens[self.next]
        self.next += 1
        if kind == "number":
            value = float(text)
            if value == float("inf"):
                raise ExpressionError(f"`{text}` is too large a number", offset)
            return Literal(int(value) if value == int(value) and abs(value) < 1e15 else value)
        if text in ("-", "~", ".-"):
            return Unary("-", self.expression(_UNARY))
        if text in ("+", ".+"):
            return self.expression(_UNARY)
        if text == "!":
            return Unary("!", self.expression(_UNARY + 2))
        if text == "(":
            inner = self.expression(0)
            self.expect(")")
            return inner
        if kind == "name":
            return self.name(text, offset)
        raise ExpressionError(f"`{text}` can't stand here" if text else "it ends too early", offset)

    def name(self, text: str, offset: int) -> ExpressionNode:
        if self.tokens[self.next][1] != "(":
            if text not in self.names and text not in ("x", "pi"):
                raise ExpressionError(f"there is no `{text}`", offset)
            return Identifier(self.names.get(text, text))
        self.next += 1
        arguments = []
        while self.tokens[self.next][1] != ")":
            arguments.append(self.expression(0))
            if self.tokens[self.next][1] != ",":
                break
            self.next += 1
        self.expect(")")
        if text == "pi" and not arguments:
            return Identifier("pi")
        if text in _COMPARISONS and len(arguments) == 2:
            return Binary(_COMPARISONS[text], *arguments)
        function = {"fabs": "abs"}.get(text, text)
        if FORMULA_FUNCTIONS.get(function) != len(arguments):
            raise ExpressionError(f"there is no function `{text}` of {len(arguments)}", offset)
        return FunctionCall(function, tuple(arguments))


def _joined(sign: str, left: ExpressionNode, right: ExpressionNode) -> ExpressionNode:
    if sign in ("^", "**"):
        return FunctionCall("pow", (left, right))
    if sign in ("and", "or"):
        return Logic("&&" if sign == "and" else "||", (left, right))
    return Binary(sign, left, right)


def write_formula(text: str, names: Mapping[str, str]) -> tuple[str, bool]:
    """Our formula as FuzzyLite's, and whether a choice in it had to be written as a sum."""
    tree = parse_expression(text)
    writer = _Writer(names)
    return writer.text(tree), writer.chose


class _Writer:
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
