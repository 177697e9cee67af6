"""Repairs a file that is invalid YAML while it is being written, by removing the lines that make it unreadable.

All other lines keep their numbers, so findings about them have the right place.
"""

import re
from typing import NamedTuple

from lumen.features.editor.fragments import ancestors, block_end
from lumen.language.text_lines import lines_of
from lumen.project.yaml_reader import parse

MAX_CUTS = 8
"""The maximum number of faulty lines removed with their blocks; beyond it, one enclosing block is removed instead."""

_WORD = re.compile(r"[^\s\"'`\[\]{},:#]+")
_QUOTED = re.compile(r"""(?:^|(?<=[\s\[{,:(]))(?P<text>"(?:[^"\\]|\\.)*(?:"|$)|'(?:[^']|'')*(?:'|$))|(?:^|\s)\#.*""")


class MendedText(NamedTuple):
    """The readable part of a text; `cut` are the indices of the removed lines."""

    text: str
    cut: frozenset[int]
    words: frozenset[str]
    """The words in the removed lines."""
    around: frozenset[int]
    """The indices of the lines whose blocks contain a removed line."""


def mended(file: str, text: str) -> MendedText | None:
    """Return the text without the lines that make it unreadable; None if removing lines does not help."""
    lines, cut = lines_of(text), set[int]()
    first: int | None = None
    for _ in range(MAX_CUTS):
        at = _fault(file, lines, cut)
        if at is None:
            return _mended(lines, cut)
        first = at if first is None else first
        cut.update(range(at, block_end(lines, at, at)))
    for outer in reversed(ancestors(lines, first or 0, 1)):
        cut = set(range(outer, block_end(lines, outer, outer)))
        if _fault(file, lines, cut) is None:
            return _mended(lines, cut)
    return None


def open_quote(line: str) -> bool:
    """Return True if a line opens a quote and does not close it."""
    return any(
        len(text) == 1 or text[0] != text[-1] or text.endswith('\\"')
        for found in _QUOTED.finditer(line)
        if (text := found["text"])
    )


def _fault(file: str, lines: list[str], cut: set[int]) -> int | None:
    """Return the index of the line that most likely makes the others unreadable; None if they can be read."""
    document, found = parse(file, _kept(lines, cut).encode("utf-8", "surrogatepass"))
    if document is not None or not found:
        return None
    at = min(found[0].place.line, len(lines)) - 1
    while at > 0 and (at in cut or not lines[at].strip()):
        at -= 1
    return next((i for i in range(at, -1, -1) if i not in cut and open_quote(lines[i])), at)


def _mended(lines: list[str], cut: set[int]) -> MendedText:
    words = frozenset(word for i in cut for word in _WORD.findall(lines[i]))
    around = frozenset(outer for i in cut for outer in ancestors(lines, i, 1))
    return MendedText(_kept(lines, cut), frozenset(cut), words, around)


def _kept(lines: list[str], cut: set[int]) -> str:
    return "\n".join("" if i in cut else line for i, line in enumerate(lines))
