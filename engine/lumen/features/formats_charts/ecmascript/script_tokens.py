"""The tokens of an ECMAScript expression."""

import re
from math import isinf

from lumen.expressions.scope import MAX_EXPRESSION_LENGTH
from lumen.expressions.tokens import Token
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
    """An expression that Lumen's language can't represent; the message is the reason."""


def tokenize_script(source: str) -> list[Token]:
    """Return the tokens of an expression, of the kinds number, text, name and sign, and a final `end`. Raises
    ScriptError.
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
