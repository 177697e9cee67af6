"""Split texts into lines in the same way wherever files are read, checked, shown or changed.

A line ends with LF, CR, or CR and LF (YAML 1.2, section 5.4, and the language server protocol). YAML 1.1 and
`str.splitlines` also end lines at U+0085, U+2028, U+2029 and more; here these are ordinary characters, as in editors.
"""

import re
from bisect import bisect_right
from itertools import accumulate

_BREAK = re.compile("(\r\n|\n|\r)")


def lines_of(text: str) -> list[str]:
    """Return the lines without their breaks; a break at the end of the text adds an empty line, as in an editor."""
    return _BREAK.split(text)[::2] if "\r" in text else text.split("\n")


def lines_and_breaks(text: str) -> tuple[list[str], list[str]]:
    """Return the lines, and the break after each; that of the last line is empty."""
    parts = _BREAK.split(text)
    return parts[::2], [*parts[1::2], ""]


class LineIndex:
    """Lines and columns of offsets in a text, found without counting from its beginning each time."""

    def __init__(self, text: str) -> None:
        lines, breaks = lines_and_breaks(text)
        self._length = len(text)
        self._starts = [0, *accumulate(len(line) + len(end) for line, end in zip(lines, breaks, strict=True))][:-1]

    def line(self, offset: int) -> int:
        """Return the number of the line, from 1, that contains an offset from 0."""
        return bisect_right(self._starts, offset)

    def column(self, offset: int) -> int:
        """Return the column of an offset, from 1."""
        return offset - self._starts[self.line(offset) - 1] + 1

    def offset(self, line: int, column: int) -> int:
        """Return the offset of a line and column, both from 1; the length of the text if they are beyond its end."""
        if line > len(self._starts):
            return self._length
        return min(self._starts[line - 1] + column - 1, self._length)
