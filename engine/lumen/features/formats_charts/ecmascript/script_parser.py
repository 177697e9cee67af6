"""Parses the text of an ECMAScript expression to its tree."""

from collections.abc import Collection
from typing import ClassVar

from lumen.expressions.pratt import CONSTANTS, PrattParser
from lumen.expressions.tokens import Token
from lumen.expressions.tree import ExpressionNode, Literal
from lumen.features.formats_charts.ecmascript.script_tokens import ScriptError, tokenize_script

_FOREIGN = {
    "function": "functions", "new": "`new`", "instanceof": "`instanceof`", "=": "assignments", "++": "`++`",
    "--": "`--`", "+=": "assignments", "-=": "assignments", "=>": "functions", "&": "operators on bits",
    "|": "operators on bits", "^": "operators on bits", "~": "operators on bits", "void": "`void`",
    "delete": "`delete`", "this": "`this`", "**": "powers", ";": "several statements", "return": "`return`",
    "var": "declarations", "let": "declarations", "const": "declarations",
}  # fmt: skip
_RESERVED = frozenset((
    "undefined", "NaN", "Infinity", "Math", "JSON", "Object", "Array", "String", "Number", "typeof", "in", "if",
    "else", "for", "while", "do", "switch", "case", "default", "break", "continue", "throw", "try", "catch",
    "finally", "with", "class", "extends", "super", "import", "export", "debugger", "enum", "yield", "await",
    "_event", "_name", "_sessionid", "_ioprocessors", "_x",
))  # fmt: skip


def parse_script(source: str) -> ExpressionNode:
    """Return the tree of an expression. Raises ScriptError if it is invalid, or uses what Lumen's language lacks."""
    return _ScriptParser(tokenize_script(source)).bounded()


def is_reserved(name: str) -> bool:
    """Return whether a name has a meaning in ECMAScript or SCXML."""
    return name in _FOREIGN or name in CONSTANTS or name in _RESERVED


class _ScriptParser(PrattParser):
    reserved = frozenset((*_FOREIGN, "in"))
    method_prefix = "."
    max_levels = 45

    def unexpected(self, hint: str = "") -> ScriptError:
        token = self.token
        if token.kind == "end":
            return ScriptError("it ends unexpectedly")
        if token.text in _FOREIGN:
            return ScriptError(f"Lumen's expressions have no {_FOREIGN[token.text]}")
        return ScriptError(f"`{token.text[:40]}` is unexpected")

    def too_deep(self, offset: int) -> ScriptError:
        return ScriptError("it is nested too deeply")

    def minus(self, power: int) -> ExpressionNode:
        """Return `-operand`; a negated number is a number."""
        negative = self.unary(power)
        operand = negative.operand
        if not isinstance(operand, Literal) or isinstance(operand.value, bool | str | None):
            return negative
        return Literal(-operand.value, offset=negative.offset, end=negative.end)

    def map_key(self, entries: Collection[str]) -> str:
        if self.token.kind in ("sign", "end"):
            raise self.unexpected()
        key = self.advance()
        return key.text if key.kind == "name" else str(key.value)

    def call(self, left: ExpressionNode, sign: Token, power: int) -> ExpressionNode:
        raise ScriptError("only named functions can be called")

    operands: ClassVar = {
        "number": PrattParser.literal,
        "text": PrattParser.literal,
        "name": PrattParser.name,
    }
    prefixes: ClassVar = {
        **dict.fromkeys(("!", "+", "typeof"), (8, PrattParser.unary)),
        "-": (8, minus),
        "(": (0, PrattParser.group),
        "[": (0, PrattParser.list_literal),
        "{": (0, PrattParser.map_literal),
    }
    infixes: ClassVar = {
        "?": (1, PrattParser.conditional),
        "||": (2, PrattParser.logic),
        "&&": (3, PrattParser.logic),
        **dict.fromkeys(("==", "!=", "===", "!=="), (4, PrattParser.binary)),
        **dict.fromkeys(("<", "<=", ">", ">=", "in"), (5, PrattParser.binary)),
        **dict.fromkeys(("+", "-"), (6, PrattParser.binary)),
        **dict.fromkeys(("*", "/", "%"), (7, PrattParser.binary)),
        ".": (9, PrattParser.member),
        "[": (9, PrattParser.index),
        "(": (9, call),
    }
