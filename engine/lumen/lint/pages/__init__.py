"""What is to be said about each code: what it means, why it matters, an example of what is wrong and of what is right.

Beside this file stands a `CODE.md` for each code: a paragraph that says what, paragraphs that say why, `Wrong:` and
`Right:` with the same files in both. An example is a fenced block whose info string names its language and its file; in
a wrong one also the word that lint marks, as in `yaml behaviors/tour.yaml:3:11-15` (line, first column, column after
the last). The keys at the left edge of an example replace those of a small sound project; all others stay.

Only who explains reads these files: lint itself does not.
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
    """The word of an example that lint points at; line and columns from 1, the last column exclusive."""

    line: int
    first: int
    last: int


class Example(NamedTuple):
    """A file of an example. `note` is for more than its text: `latin-1`, or `folder` in place of the file.

    `installed` is a module of an installed distribution with an entry point for the module's `FEATURE`.
    """

    file: str
    language: str
    text: str
    mark: MarkedWord | None = None
    note: str = ""


class Page(NamedTuple):
    """All that is to be said about a code; `what` and `why` are Markdown."""

    code: str
    what: str
    why: str
    wrong: tuple[Example, ...]
    right: tuple[Example, ...]


@cache
def page(code: str) -> Page:
    """Return the page of one of `codes()`; of a code without a page, its summary.

    Raises LumenError if a package of pages was installed beside Lumen and can't be read.
    """
    text = ""
    for feature, package in rows("pages"):
        with blaming(feature, package):
            file = files(resolve(package)) / f"{code}.md"
            text = text or (file.read_text(encoding="utf-8") if file.is_file() else "")
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
