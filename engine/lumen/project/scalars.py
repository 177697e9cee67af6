"""Find the place of each character of a value in the YAML text that contains it.

YAML folds lines, strips indentation and has escapes, but apart from white space it keeps the characters in order. So
the visible characters of a value are located one after the other.
"""

import re
from bisect import bisect_right
from collections.abc import Iterator

from lumen.language.diagnostics import Place
from lumen.language.text_lines import LineIndex

_PROPERTIES = re.compile(r"(?:[&!]\S*\s+)*")
_HEADER = re.compile(r"[|>][^\r\n]*(?:\r\n?|\n)")
_QUOTED = re.compile(r"''|.", re.DOTALL)
_ESCAPED = re.compile(r"\\x[0-9a-fA-F]{2}|\\u[0-9a-fA-F]{4}|\\U[0-9a-fA-F]{8}|\\\r?\n|\\.|.", re.DOTALL)
_ANY = re.compile(r".", re.DOTALL)
_LETTERS = {
    "0": "\0", "a": "\a", "b": "\b", "t": "\t", "n": "\n", "v": "\v", "f": "\f", "r": "\r", "e": "\x1b",
    "N": "\x85", "_": "\xa0", "L": "\u2028", "P": "\u2029",
}  # fmt: skip
"""The meaning of a letter after a backslash in double quotes (YAML 1.2, 5.7); other characters mean themselves."""

Unit = tuple[int, int, str]
"""The start and end offset of a character of the value in the text, and the character."""


def within(text: str, place: Place, value: str, offset: int, length: int) -> Place | None:
    """Return the place of `length` characters from `offset` in the value at `place` in a file's text.

    Return None if the characters of the value can't be located.
    """
    lines = LineIndex(text)
    begin, end = (lines.offset(line, column) for line, column in _corners(place))
    written = [unit for unit in _units(text, begin, end) if not unit[2].isspace()]
    wanted = [i for i, sign in enumerate(value) if not sign.isspace()]
    if not wanted or [unit[2] for unit in written[: len(wanted)]] != [value[i] for i in wanted]:
        return None
    first = bisect_right(wanted, max(offset - 1, -1))
    last = max(bisect_right(wanted, offset + length - 1) - 1, 0)
    if first > last:  # only blanks, or the end: use the character before it
        first = last
    (line, column), (end_line, end_column) = (
        (lines.line(at), lines.column(at)) for at in (written[first][0], written[last][1])
    )
    return place._replace(line=line, column=column, end_line=end_line, end_column=end_column)


def _corners(place: Place) -> Iterator[tuple[int, int]]:
    yield place.line, place.column
    yield place.end_line, place.end_column


def _units(text: str, begin: int, end: int) -> Iterator[Unit]:
    """Yield the characters of the value between two offsets, with escapes decoded and blanks included.

    Anchors, tags, the header of a block and the quotes are skipped.
    """
    found = _PROPERTIES.match(text, begin, end)
    begin = found.end() if found else begin
    if header := _HEADER.match(text, begin, end):
        begin = header.end()
    style = text[begin : begin + 1] if not header else ""
    signs = {"'": _QUOTED, '"': _ESCAPED}.get(style)
    if signs:
        begin, end = begin + 1, end - 1
    for match in (signs or _ANY).finditer(text, begin, end):
        yield match.start(), match.end(), _meant(match[0])


def _meant(written: str) -> str:
    if len(written) == 1 or written == "''":
        return written[0]
    letter, digits = written[1], written[2:]
    return chr(int(digits, 16)) if digits and letter in "xuU" else _LETTERS.get(letter, letter)
