"""The words of an ECMAScript expression."""

import re
from typing import NamedTuple

_WORD = re.compile(
    r"""(?P<blank>(?:\s|//[^\n]*|/\*.*?\*/)+)
    | (?P<number>0[xX][0-9a-fA-F]+|(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)
    | (?P<text>'(?:[^'\\\n]|\\.)*'|"(?:[^"\\\n]|\\.)*")
    | (?P<name>[A-Za-z_$][\w$]*)
    | (?P<sign>===|!==|==|!=|<=|>=|&&|\|\||\+\+|--|\+=|-=|\*=|/=|%=|\*\*|=>|[-+*/%<>!?:.,()\[\]{}=&|^~;])""",
    re.VERBOSE | re.DOTALL,
)
_ESCAPE = re.compile(r"\\(?:u\{([0-9a-fA-F]{1,6})\}|u([0-9a-fA-F]{4})|x([0-9a-fA-F]{2})|(.))", re.DOTALL)
_SIMPLE = {"n": "\n", "t": "\t", "r": "\r", "b": "\b", "f": "\f", "v": "\v", "0": "\0", "\n": ""}

MAX_SCRIPT_LENGTH = 2_000
"""Characters in an expression, as in ours."""


class ScriptError(Exception):
    """An expression that can't be said in our language; the message says why."""


class ScriptToken(NamedTuple):
    """`kind` is number, text, name, sign or end."""

    kind: str
    text: str
    value: int | float | str | None = None


def tokenize_script(source: str) -> list[ScriptToken]:
    """The words of an expression, the last one of kind `end`; raises ScriptError."""
    if len(source) > MAX_SCRIPT_LENGTH:
        raise ScriptError(f"it has more than {MAX_SCRIPT_LENGTH:,} characters")
    found, offset = [], 0
    while offset < len(source):
        match = _WORD.match(source, offset)
        if match is None or match.lastgroup is None:
            raise ScriptError(f"`{source[offset : offset + 12]}` can't be read")
        if match.lastgroup != "blank":
            found.append(_word(match.lastgroup, match[0]))
        offset = match.end()
    return [*found, ScriptToken("end", "")]


def _word(kind: str, text: str) -> ScriptToken:
    if kind == "number":
        if text[:2] in ("0x", "0X"):
            return ScriptToken(kind, text, int(text, 16))
        return ScriptToken(kind, text, int(text) if text.isdecimal() else float(text))
    if kind == "text":
        return ScriptToken(kind, text, _ESCAPE.sub(_unescaped, text[1:-1]))
    return ScriptToken(kind, text)


def _unescaped(match: re.Match[str]) -> str:
    code = match[1] or match[2] or match[3]
    if code is None:
        return _SIMPLE.get(match[4], match[4])
    number = int(code, 16)
    if number > 0x10FFFF or 0xD800 <= number <= 0xDFFF:
        raise ScriptError(f"`{match[0]}` is no character")
    return chr(number)
