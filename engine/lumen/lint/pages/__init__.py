"""The explanation of each code: its meaning, why it matters, a wrong and a right example.

This folder has a `CODE.md` for each code: a paragraph with the meaning, paragraphs with the reasons, and `Wrong:` and
`Right:` with the same files in both. An example is a fenced block whose info string names its language and its file; in
a wrong one also the word that lint marks, as in `yaml behaviors/tour.yaml:3:11-15` (line, first column, column after
the last). The top-level keys of an example replace those of a small valid project; all others stay.

These files are read only to explain a code, not by lint.
"""

import re
from functools import cache
from importlib.resources import files
from typing import NamedTuple

from lumen.feature import resolve, rows
from lumen.lint.codes import codes
from lumen.project.broken_features import blaming

_FENCE = re.compile(
    r"^```(?P<language>\w+) (?P<file>\S+?)(?::(?P<line>\d+):(?P<first>\d+)-(?P<last>\d+))?(?: (?P<note>[^\n]+))?\n"
    r"(?P<text>.*?)^```$",
    re.MULTILINE | re.DOTALL,
)


class MarkedWord(NamedTuple):
    """The word of an example that lint marks."""

    line: int
    """The line, from 1."""
    first: int
    """The first column, from 1."""
    last: int
    """The column after the word, from 1."""


class Example(NamedTuple):
    """A file of an example."""

    file: str
    language: str
    """The language of its code block, such as `yaml`."""
    text: str
    mark: MarkedWord | None = None
    """The word that lint marks; None in a right example."""
    note: str = ""
    """A special case: `latin-1` (the encoding), `folder` (instead of a file) or `installed` (in another package)."""


class Page(NamedTuple):
    """The explanation of a code."""

    code: str
    """The code that is explained."""
    what: str
    """The meaning, in Markdown."""
    why: str
    """The reasons, in Markdown."""
    wrong: tuple[Example, ...]
    """The files of the wrong example."""
    right: tuple[Example, ...]
    """The files of the wrong example, corrected."""


@cache
def page(code: str) -> Page:
    """Return the page of one of `codes()`; for a code without a page, its summary.

    Raises LumenError if pages of another installed package, which may have this one, can't be read.
    """
    text = ""
    for feature, package in rows("pages"):
        with blaming(feature, package):
            if not text and (file := files(resolve(package)) / f"{code}.md").is_file():
                text = file.read_text(encoding="utf-8")
    if not text:
        return Page(code, f"{codes()[code].summary.capitalize()}.", "", (), ())
    said, _, examples = text.partition("\nWrong:\n")
    wrong, _, right = examples.partition("\nRight:\n")
    what, _, why = said.strip().partition("\n\n")
    return Page(code, what, why.strip(), _examples(wrong), _examples(right))


def _examples(text: str) -> tuple[Example, ...]:
    return tuple(
        Example(
            found["file"],
            found["language"],
            found["text"],
            MarkedWord(*(int(found[key]) for key in ("line", "first", "last"))) if found["line"] else None,
            found["note"] or "",
        )
        for found in _FENCE.finditer(text)
    )
