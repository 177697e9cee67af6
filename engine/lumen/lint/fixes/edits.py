"""Edits of a file's text, and access to the text by lines and columns."""

from collections.abc import Sequence
from typing import NamedTuple

from lumen.language.diagnostics import Place
from lumen.language.text_lines import lines_and_breaks

_BOM = b"\xef\xbb\xbf"


class Edit(NamedTuple):
    """The replacement of the text at `place` by `text`."""

    place: Place
    text: str


class Fix(NamedTuple):
    """A repair: its effect in words for people, and its edits."""

    title: str
    edits: tuple[Edit, ...]


class FileText:
    """The text of a file, by line and column as places count them."""

    def __init__(self, file: str, content: bytes) -> None:
        self.file = file
        self.bom = content.startswith(_BOM)
        self.text = content.decode("utf-8-sig", "replace")
        self.lines, self.breaks = lines_and_breaks(self.text)

    def line(self, number: int) -> str:
        """Return the line with that number, counted from 1; empty if there is none."""
        return self.lines[number - 1] if 0 < number <= len(self.lines) else ""

    def at(self, place: Place) -> str:
        """Return the text at a place within one line; empty if the place spans several lines."""
        one = place.line == place.end_line
        return self.line(place.line)[place.column - 1 : place.end_column - 1] if one else ""

    def whole(self, number: int) -> Place:
        """Return the place of a line including its line break."""
        if number < len(self.lines):
            return Place(self.file, number, 1, number + 1, 1)
        return Place(self.file, number, 1, number, len(self.line(number)) + 1)

    def offset(self, line: int, column: int) -> int:
        """Return the index in the text of a line and column, both from 1; the length of the text if it is shorter."""
        before = sum(len(t) + len(b) for t, b in zip(self.lines[: line - 1], self.breaks, strict=False))
        return min(before + column - 1, len(self.text))


def edited(content: bytes, edits: Sequence[Edit]) -> bytes:
    """Return the file after these edits; of two overlapping edits, only the later in the file is made."""
    source = FileText("", content)
    spans = [(source.offset(*e.place[1:3]), source.offset(*e.place[3:5]), e.text) for e in dict.fromkeys(edits)]
    text, done = source.text, len(source.text) + 1
    for start, end, new in sorted(spans, reverse=True):
        if end <= done and not (end == done and start == end):
            text, done = text[:start] + new + text[end:], start
    return (_BOM if source.bom else b"") + text.encode("utf-8", "surrogatepass")
