"""The parts of a file that can be folded: everything below a key, and comments of several lines."""

from collections.abc import Iterator
from typing import NamedTuple

from lumen.language.text_lines import lines_of
from lumen.project.document import Document


class Fold(NamedTuple):
    """The first and last line, from 1, of a range that folds into its first line; `comment` is False for a key."""

    first: int
    last: int
    comment: bool = False


def folds(document: Document) -> list[Fold]:
    """Return all folds of a document in order, only the longest of those that begin in the same line."""
    lines, found = lines_of(document.text), dict[int, Fold]()
    for fold in (*_nodes(document, lines), *_comments(lines)):
        if fold.last > fold.first and (fold.first not in found or found[fold.first].last < fold.last):
            found[fold.first] = fold
    return sorted(found.values())


def _nodes(document: Document, lines: list[str]) -> Iterator[Fold]:
    for span in document.spans.values():
        first = span.key.line if span.key else span.value.line
        last = min(span.value.end_line, len(lines))
        if span.value.end_line <= len(lines) and not lines[last - 1][: span.value.end_column - 1].strip():
            last -= 1  # the span ends at the beginning of the next node
        while last > first and (not lines[last - 1].strip() or _is_comment(lines[last - 1])):
            last -= 1
        if span.key or first > 1:
            yield Fold(first, last)


def _comments(lines: list[str]) -> Iterator[Fold]:
    first = 0
    for number, line in enumerate([*lines, ""], 1):
        if _is_comment(line):
            first = first or number
        elif first:
            yield Fold(first, number - 1, comment=True)
            first = 0


def _is_comment(line: str) -> bool:
    return line.lstrip().startswith("#")
