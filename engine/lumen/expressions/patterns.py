"""Regular expressions without backtracking, for `matches` and for every JSON Schema.

Python's `re` backtracks, so a harmless pattern can take minutes on a text from a message. jsonschema-rs compiles the
patterns instead: its engine, Rust's `regex`, takes time proportional to the text (docs/decisions/021). It does not
explain why a pattern is invalid; this module does.
"""

import re
from collections.abc import Callable, Sequence
from functools import lru_cache

from lumen.errors import ExpressionError

_EVERY_SCRIPT = {"w": r"\p{XIDC}", "W": r"\P{XIDC}", "d": r"\p{Nd}", "D": r"\P{Nd}"}
"""Escapes that match letters and digits of every script, as in Python; JSON Schema's own match only ASCII."""

_PIECE = re.compile(
    r"\\(?:x[0-9a-fA-F]{2}|u[0-9a-fA-F]{4}|[pP]\{\w*\}|.)|\\"  # an escape
    r"|\[\^?\]?(?:\\.|[^\\\]])*\]|\["  # a set
    r"|\(\?(?:P?<\w+>|[a-zA-Z]*(?:-[a-zA-Z]+)?[:)])|\(\??"  # the beginning of a group, or a switch such as `(?i)`
    r"|(?:[*+?]|\{\d+(?:,\d*)?\})\??"  # a number of repetitions
    r"|.",
    re.DOTALL,
)
_BOUNDS = re.compile(r"\{(\d+),(\d+)\}")

PatternPiece = tuple[str, int]
"""A character, set, repetition or beginning of a group, with its offset in the source."""


class CompiledPattern:
    """A compiled pattern; `search` returns whether it matches anywhere in a text."""

    __slots__ = ("_occurs_in",)

    def __init__(self, occurs_in: Callable[[str], bool]) -> None:
        self._occurs_in = occurs_in

    def search(self, text: str) -> bool:
        """Return True if the pattern matches anywhere in the text."""
        try:
            return self._occurs_in(str(text))
        except UnicodeEncodeError:  # half a surrogate pair, which no UTF-8 can hold
            return self._occurs_in(text.encode("utf-16", "surrogatepass").decode("utf-16", "replace"))


@lru_cache(maxsize=512)
def compile_pattern(source: str) -> CompiledPattern:
    """Return the compiled pattern; raise ExpressionError, with the offset in `source`, if it is invalid."""
    pieces = [(found[0], found.start()) for found in _PIECE.finditer(source)]
    _check_repetitions(pieces)
    if (occurs_in := _read(source)) is None:
        _check_characters(pieces)
        _check_groups(pieces)
        raise ExpressionError("the pattern is too large", 0, "use fewer repetitions, and give each group its own name")
    return CompiledPattern(occurs_in)


def for_every_script(source: str) -> str:
    """Return the pattern for Rust's `regex`, with `\\w` and `\\d` extended to letters and digits of every script."""
    return re.sub(r"\\(.)", _meant, source, flags=re.DOTALL)


def _meant(escape: re.Match[str]) -> str:
    sign = escape[1]
    return _EVERY_SCRIPT.get(sign, escape[0] if sign.isascii() else sign)


def _read(source: str) -> Callable[[str], bool] | None:
    """Return a function that searches a text for the pattern; None if the engine rejects the pattern."""
    from jsonschema_rs import Draft202012Validator, RegexOptions  # takes 40 ms: import it only for a pattern

    try:
        return Draft202012Validator({"pattern": for_every_script(source)}, pattern_options=RegexOptions()).is_valid
    except ValueError:
        return None


def _check_repetitions(pieces: Sequence[PatternPiece]) -> None:
    """Raise ExpressionError for a repetition of nothing or of a repetition, and for bounds in the wrong order."""
    before = "("
    for piece, at in pieces:
        sign = piece[0]
        if sign in "*+?{":
            if before[0] in "(|" or piece == "{":
                hint = rf"write `\{sign}` for the character itself"
                raise ExpressionError(f"`{sign}` has nothing before it to repeat", at, hint)
            if before[0] in "*+?{":
                raise ExpressionError("two repetition signs follow each other", at, "one `*`, `+` or `?` is enough")
            if (bounds := _BOUNDS.match(piece)) and int(bounds[1]) > int(bounds[2]):
                raise ExpressionError(f"`{bounds[0]}` counts downwards", at, f"write `{{{bounds[2]},{bounds[1]}}}`")
        before = piece


def _check_characters(pieces: Sequence[PatternPiece]) -> None:
    """Raise ExpressionError for the first escape or set that the engine rejects."""
    for piece, at in pieces:
        if piece[0] == "\\" and piece[1:2] in tuple("123456789k"):
            hint = "write out the characters to match"
            raise ExpressionError(f"`{piece}` refers to an earlier match, which is not allowed", at, hint)
        if piece == "[":
            raise ExpressionError("this `[` is not closed", at, r"look for a missing bracket, or write `\[`")
        if piece[0] == "[" and _read(piece) is None:
            hint = "write a backslash before a character that is meant literally"
            raise ExpressionError(f"`{piece[:40]}` is not a set of characters", at, hint)
        if piece[0] == "\\" and _read(piece) is None:
            raise ExpressionError(f"`{piece}` has no meaning in a pattern", at, r"write `\\` for a backslash")


def _check_groups(pieces: Sequence[PatternPiece]) -> None:
    """Raise ExpressionError for a group of an unsupported kind, and for brackets that are not closed or not opened."""
    opened: list[int] = []
    for piece, at in pieces:
        if piece[:2] == "(?" and _read(piece.removesuffix(")") + ")") is None:
            hint = "write `(…)` or `(?:…)`: lookahead and lookbehind are not allowed"
            raise ExpressionError("this kind of `(?` group is not allowed", at, hint)
        if piece[0] == "(" and piece[-1] != ")":
            opened.append(at)
        elif piece == ")":
            if not opened:
                raise ExpressionError("a `(` is missing for this `)`", at, r"look for a missing bracket, or write `\)`")
            opened.pop()
    if opened:
        raise ExpressionError("this `(` is not closed", opened[-1], r"look for a missing bracket, or write `\(`")
