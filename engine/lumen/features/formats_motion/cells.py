"""Lines of cells with their places, as in both dialects of `.motion`."""

from collections.abc import Iterator

from lumen.language.diagnostics import Place
from lumen.language.text_lines import lines_of

Cell = tuple[str, Place]


def cells_of(file: str, text: str, separator: str) -> Iterator[list[Cell]]:
    """Yield the cells of every line that is not empty, without surrounding blanks."""
    for i, line in enumerate(lines_of(text), 1):
        if line.strip():
            yield list(_cells(file, i, line, separator))


def _cells(file: str, row: int, line: str, separator: str) -> Iterator[Cell]:
    column = 1
    for cell in line.split(separator):
        begin = column + len(cell) - len(cell.lstrip())
        word = cell.strip()
        yield word, Place(file, row, begin, row, begin + max(len(word), 1))
        column += len(cell) + 1
