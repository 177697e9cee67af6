"""Lines and columns of offsets in a text, found without counting from its beginning each time."""

from bisect import bisect_right
from itertools import accumulate


class LineIndex:
    """Where each line of a text begins; lines end with a newline."""

    def __init__(self, text: str) -> None:
        self._starts = [0, *accumulate(len(line) + 1 for line in text.split("\n"))]

    def line(self, offset: int) -> int:
        """The number of the line, from 1, that an offset from 0 lies in."""
        return bisect_right(self._starts, offset)

    def column(self, offset: int) -> int:
        """The column, from 1."""
        return offset - self._starts[self.line(offset) - 1] + 1
