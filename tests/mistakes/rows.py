"""Changes to sound projects: mistakes in table/, and changes in legal/ that look odd and are right.

Each file groups rows by subject. A row changes one file of a project:

    a verb without its colon:
      in: tour                      # or museum or talk; the file is its behaviour, if no `file` is named
      file: behaviors/tour.yaml
      after: "  dance:"             # `change` begins to look behind this text
      change: ["- {play: dance}", "- play dance"]     # a text that occurs there once, and its replacement; or
      write: {motions/bow.yaml: "…"}                  # files as a whole
      found: lumen.yaml             # the file to report it in, if it is another one
      at: play dance                # the line to report: the nearest one with this text, else the first that differs
      says: "`play: dance`"         # is in the message or the hint; one text of a list is enough

The place and the words are what a person would want to be told, whatever lint says today.
"""

from collections.abc import Iterator, Mapping
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

from lumen.project.files import read_files
from lumen.project.yaml_reader import parse
from tests import ROOT
from tests.scanning import matching

HERE = Path(__file__).parent
FROZEN = ROOT / "tests/golden/projects"
PROJECTS = {
    "tour": FROZEN / "tour",
    "museum": FROZEN / "museum",
    "talk": ROOT / "tests/lint/hearing",
    "fog": ROOT / "tests/features/skills/project",
}
"""Copies that stay as they are, so that an edit of the shipped tour changes no row."""

TORN = b"Was sagte dem Webstuhl, was er weben soll?"
"""A text of the frozen museum that lacks its quotes, which lint reports by now."""


class Row(NamedTuple):
    """A changed project; `file` and `line` are where the finding belongs, `says` words of which it has one."""

    name: str
    root: Path
    files: Mapping[str, bytes]
    file: str
    line: int
    says: tuple[str, ...]


@cache
def shipped(project: str) -> Mapping[str, bytes]:
    """Return the files of a project as it is."""
    return {file: content.replace(TORN, b'"' + TORN + b'"') for file, content in read_files(PROJECTS[project]).items()}


def rows(folder: str) -> Iterator[Row]:
    """Yield the rows of each file in that folder."""
    for path in matching(HERE / folder, "*.yaml"):
        document, diagnostics = parse(path.name, path.read_bytes())
        assert document, diagnostics
        assert not diagnostics, diagnostics[0]
        yield from (_row(f"{path.stem}: {name}", data) for name, data in document.data.items())


def _row(name: str, data: Mapping[str, Any]) -> Row:
    project = data["in"]
    file, files = data.get("file", f"behaviors/{project}.yaml"), dict(shipped(project))
    line = 1
    if "change" in data:
        before, (old, new) = files[file].decode(), data["change"]
        start = before.index(data["after"]) if "after" in data else 0
        place = before.find(old, start)
        assert place >= 0, f"{name}: {old!r} is not in {file}"
        after = before[:place] + new + before[place + len(old) :]
        assert after != before, name
        files[file] = after.encode()
        line = _first(before.split("\n"), after.split("\n"))
    for other, content in data.get("write", {}).items():
        files[other] = content.encode()
        file = data.get("file", other)
    file = data.get("found", file)
    if "at" in data:
        texts = files[file].decode().split("\n")
        near = [i for i, text in enumerate(texts, 1) if data["at"] in text]
        assert near, f"{name}: {data['at']!r} is not in {file}"
        line = min(near, key=lambda i: abs(i - line))
    says = data.get("says", ())
    return Row(name, PROJECTS[project], files, file, line, (says,) if isinstance(says, str) else tuple(says))


def _first(old: list[str], new: list[str]) -> int:
    """Return the number of the first line that differs, from 1."""
    return next((i for i, (a, b) in enumerate(zip(old, new, strict=False), 1) if a != b), min(len(old), len(new)))
