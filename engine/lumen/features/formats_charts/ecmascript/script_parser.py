"""Tokenizes and parses ECMAScript expressions."""

import re
from collections.abc import Collection
from math import isinf
from typing import ClassVar

from lumen.expressions.pratt import CONSTANTS, PrattParser
from lumen.expressions.scope import MAX_EXPRESSION_LENGTH
from lumen.expressions.tokens import Token
from lumen.expressions.tree import ExpressionNode, Literal
from lumen.project.yaml_scalars import MAX_DIGITS

_TOKEN = re.compile(
    r"""(?P<blank>(?:\s|//[^\n]*|/\*.*?\*/)+)
    | (?P<number>0[xX][0-9a-fA-F]+|(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)
    | (?P<text>'(?:[^'\\\n]|\\.)*'|"(?:[^"\\\n]|\\.)*")
    | (?P<name>[A-Za-z_$][\w$]*)
    | (?P<sign>===|!==|==|!=|<=|>=|&&|\|\||\+\+|--|\+=|-=|\*=|/=|%=|\*\*|=>|[-+*/%<>!?:.,()\[\]{}=&|^~;])""",
    re.VERBOSE | re.DOTALL,
)
_ESCAPE = re.compile(r"\\(?:u\{([0-9a-fA-F]{1,6})\}|u([0-9a-fA-F]{4})|x([0-9a-fA-F]{2})|(.))", re.DOTALL)
_SIMPLE = {"n": "\n", "t": "\t", "r": "\r", "b": "\b", "f": "\f", "v": "\v", "0": "\0", "\n": ""}


class ScriptError(Exception):
    """An expression is invalid or can't be translated; the message is the reason."""


def tokenize_script(source: str) -> list[Token]:
    """Return an expression's tokens, whose kinds are `number`, `text`, `name` and `sign`, and a final `end`.

    Raises ScriptError if the source is too long or contains an invalid token.
    """
    if len(source) > MAX_EXPRESSION_LENGTH:
        raise ScriptError(f"it is longer than {MAX_EXPRESSION_LENGTH:,} characters")
    found, offset = [], 0
    while offset < len(source):
        match = _TOKEN.match(source, offset)
        if match is None or match.lastgroup is None:
            raise ScriptError(f"`{source[offset : offset + 12]}` can't be read")
        if match.lastgroup != "blank":
            found.append(Token(match.lastgroup, match[0], offset, _value(match.lastgroup, match[0])))
        offset = match.end()
    return [*found, Token("end", "", len(source))]


def _value(kind: str, text: str) -> int | float | str | None:
    if kind == "number":
        return _number(text)
    return _ESCAPE.sub(_unescaped, text[1:-1]) if kind == "text" else None


def _number(text: str) -> float:
    if len(text) < MAX_DIGITS and text[:2] in ("0x", "0X"):
        return int(text, 16)
    if len(text) < MAX_DIGITS and text.isdecimal():
        return int(text)
    if text[:2] in ("0x", "0X") or isinf(value := float(text)):
        raise ScriptError(f"the number `{text[:40]}` is too large")
    return value


def _unescaped(match: re.Match[str]) -> str:
    code = match[1] or match[2] or match[3]
    if code is None:
        return _SIMPLE.get(match[4], match[4])
    number = int(code, 16)
    if number > 0x10FFFF or 0xD800 <= number <= 0xDFFF:
        raise ScriptError(f"`{match[0]}` is not a character")
    return chr(number)


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
    """Return an expression's tree. Raises ScriptError if it is invalid or uses syntax that Lumen does not support."""
    return _ScriptParser(tokenize_script(source)).bounded()


def is_reserved(name: str) -> bool:
    """Return whether a name is reserved in ECMAScript or SCXML."""
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
        """Return `-operand`, as a literal if the operand is a number."""
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
