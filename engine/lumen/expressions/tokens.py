"""The tokens of an expression, with their offsets."""

import re
from typing import NamedTuple

from lumen.errors import ExpressionError
from lumen.expressions.scope import MAX_EXPRESSION_LENGTH
from lumen.language.lookalikes import other_sign, typed

_TOKEN = re.compile(
    r"""(?P<blank>[ \t\r\n]+)
    | (?P<float>(?:\d+\.\d+|\.\d+)(?:[eE][+-]?\d+)?|\d+[eE][+-]?\d+)
    | (?P<int>0[xX][0-9a-fA-F]+|\d+)
    | (?P<raw>[rR](?:'[^'\n]*'|"[^"\n]*"))
    | (?P<text>'(?:[^'\\\n]|\\.)*'|"(?:[^"\\\n]|\\.)*")
    | (?P<name>[A-Za-z_]\w*)
    | (?P<sign>&&|\|\||==|!=|<=|>=|[-+*/%<>!?:.,()\[\]{}])""",
    re.VERBOSE | re.ASCII,
)
_ESCAPE = re.compile(r"\\(x[0-9a-fA-F]{2}|u[0-9a-fA-F]{4}|U[0-9a-fA-F]{8}|[0-3][0-7]{2}|.)")
_FILTER = re.compile(r"\|\s*(?P<name>[A-Za-z_]\w*)\b(?!\.)(?:\((?P<given>[^()]*)\))?")
_FILTERS = frozenset((
    "abs", "capitalize", "count", "default", "escape", "first", "float", "format", "int", "join", "last", "length",
    "lower", "replace", "round", "safe", "size", "sort", "string", "title", "trim", "truncate", "upper",
))  # fmt: skip
"""Filters of Jinja and Liquid."""
_SIMPLE = dict(zip("abfnrtv\\?\"'`", "\a\b\f\n\r\t\v\\?\"'`", strict=True))
_HINTS = {
    "=": "compare with `==`",
    "&": "write `&&`",
    "|": "write `||`",
    "'": "close the text with `'`",
    '"': 'close the text with `"`',
    "^": "there is no operator for powers: multiply",
    ";": "delete the `;`: an expression is a single value",
} | dict.fromkeys("“”„‘’«»", "put texts in straight quotes: 'text'")


class Token(NamedTuple):
    """A token of an expression."""

    kind: str
    """One of `int`, `float`, `text`, `name`, `sign` and `end`; `token_at` also returns `blank`."""
    text: str
    """The source of the token."""
    offset: int
    """The offset of the token in the source of the expression [characters]."""
    value: int | float | str | None = None
    """The value of a literal, None for other kinds."""

    @property
    def end(self) -> int:
        """Return the offset after the token."""
        return self.offset + len(self.text)


def tokenize(source: str) -> list[Token]:
    """Return the tokens of a whole expression, the last of kind `end`; raise ExpressionError for invalid parts."""
    if len(source) > MAX_EXPRESSION_LENGTH:
        raise ExpressionError(
            f"the expression has {len(source):,} characters",
            MAX_EXPRESSION_LENGTH,
            f"at most {MAX_EXPRESSION_LENGTH:,} are allowed",
        )
    tokens, offset = [], 0
    while offset < len(source):
        token = token_at(source, offset)
        offset = token.end
        if token.kind != "blank":
            tokens.append(token)
    return [*tokens, Token("end", "", len(source))]


def token_at(source: str, offset: int) -> Token:
    """Return the token (or `blank`) at `offset`; raise ExpressionError if no token begins there."""
    match = _TOKEN.match(source, offset)
    if match is None or match.lastgroup is None:
        character = source[offset]
        what = "this text is not closed" if character in "'\"" else f"`{character}` has no meaning here"
        raise ExpressionError(what, offset, _filter(source, offset) or _HINTS.get(character) or _other(source, offset))
    kind, text = match.lastgroup, match[0]
    if kind in ("int", "float"):
        return Token(kind, text, offset, _number(source, kind, text, match.end()))
    if kind == "raw":
        return Token("text", text, offset, text[2:-1])
    if kind == "text":
        return Token("text", text, offset, _unescape(text[1:-1], offset + 1))
    return Token(kind, text, offset)


def _filter(source: str, offset: int) -> str:
    """Return the hint for a filter such as `| title`; empty for any other text."""
    found = _FILTER.match(source, offset)
    if found is None or found["name"] not in _FILTERS:
        return ""
    value = source[:offset].rpartition("{{")[2].strip()
    name = {"length": "size", "count": "size"}.get(found["name"], found["name"])
    if name in ("lower", "size", "trim"):
        return f"there are no filters: write `{name}({value})`"
    if name == "default" and found["given"]:
        return f"there are no filters: write `has({value}) ? {value} : {found['given']}`"
    return f"there are no filters: delete `{found[0].strip()}`"


def _other(source: str, offset: int) -> str:
    """Return the hint for a character that is never allowed: one that resembles another, or an accented letter."""
    if (sign := other_sign(source[offset])) and (meant := typed(source[offset])).isascii():
        return f"write `{meant}`: {sign}" if meant else f"delete it: {sign}"
    return "write a field with such a letter in brackets: context['…']" if source[offset].isalpha() else ""


def _number(source: str, kind: str, text: str, end: int) -> int | float:
    if source[end : end + 1].isidentifier():
        hint = "write the number without `u`" if source[end] in "uU" else "add a space or an operator"
        raise ExpressionError(f"`{source[end]}` can't follow a number", end, hint)
    if kind == "int":
        return int(text, 16) if text[:2] in ("0x", "0X") else int(text)
    value = float(text)
    if value == float("inf"):
        raise ExpressionError(f"the number `{text}` is too large", end - len(text))
    return value


def _unescape(text: str, offset: int) -> str:
    def one(match: re.Match[str]) -> str:
        code = match[1]
        if code in _SIMPLE:
            return _SIMPLE[code]
        number = int(code, 8) if code[0] in "0123" else int(code[1:], 16) if len(code) > 1 else -1
        if 0 <= number <= 0x10FFFF and not 0xD800 <= number <= 0xDFFF:
            return chr(number)
        hint = r"write `\\` for a backslash, or r'…' for a text without escapes"
        raise ExpressionError(f"`{match[0]}` is not an escape", offset + match.start(), hint)

    return _ESCAPE.sub(one, text) if "\\" in text else text
