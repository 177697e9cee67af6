"""Converts between Lumen's places and the protocol's positions.

Lumen counts lines and characters from 1. The protocol counts lines and columns from 0, with columns in the client's
units.
"""

from urllib.parse import unquote, urlsplit
from urllib.request import url2pathname

from lsprotocol import types as lsp
from pygls.workspace import PositionCodec

from lumen.language.diagnostics import Place
from lumen.lint.fixes import FileText


class Ranges:
    """Converts the places of one file; `codec` counts columns in the client's units."""

    def __init__(self, text: FileText, codec: PositionCodec) -> None:
        self._text, self._codec = text, codec

    def position(self, line: int, column: int) -> lsp.Position:
        """Return the protocol's position of a line and column; the end of the file if they are beyond it."""
        count = len(self._text.lines)
        if line > count:
            line, column = count, len(self._text.line(count)) + 1
        before = self._text.line(line)[: column - 1]
        return lsp.Position(line - 1, self._codec.client_num_units(before))

    def range(self, place: Place) -> lsp.Range:
        """Return the protocol's range of a place, an empty one if the place ends before it begins."""
        start, end = self.position(place.line, place.column), self.position(place.end_line, place.end_column)
        return lsp.Range(start, max(start, end, key=lambda p: (p.line, p.character)))

    def place(self, position: lsp.Position) -> tuple[int, int]:
        """Return the line and column, from 1, of a client's position; the line's end if the position is beyond it."""
        text = self._text.line(position.line + 1)
        units, column = 0, 0
        while column < len(text) and units < position.character:
            units += self._codec.client_num_units(text[column])
            column += 1
        return position.line + 1, column + 1


def path_of(uri: str) -> str:
    """Return the local path of a `file:` URI; empty for other URIs."""
    parts = urlsplit(uri)
    return url2pathname(unquote(parts.path)) if parts.scheme == "file" else ""
