"""After a key, only a block of a file is read and judged again, with the result of a first reading."""

from pathlib import Path
from typing import Any
from unittest.mock import patch

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lumen.lint import check_files
from lumen.project import memoization as recollection
from lumen.project import yaml_reader
from lumen.project.document import Document
from lumen.project.files import read_files
from lumen.project.rereading import reread
from lumen.project.yaml_reader import parse
from tests import ROOT
from tests.tables import for_each

BASE = read_files(ROOT / "tests/lint/base")
TOUR = "behaviors/tour.yaml"
ODD = """\
# A comment
plain: &no text   # goes on
folded: >
  some words
  # and no comment

map:
  inner:
    one: 1
    "two words": {a: 1,
      b: [2, 3]}
    # between
  other:
      - a: 1
        b: "over
          lines"
      - |
        kept

  last:
    deep:
      deeper: yes
    # behind
end:
  of: it
"""
WHOLE = ODD.replace("&no ", "")
EDITS = st.lists(
    st.tuples(
        st.integers(0, 200),
        st.integers(0, 40),
        st.integers(0, 3),
        st.sampled_from(["", *"ax1:-#{}[]\"'|>&*,% ", ": ", "- ", "  ", "---", "x: ", "<<<<<<< "])
        | st.text(max_size=2),
    ),
    min_size=1,
    max_size=4,
)


def edited(text: str, at: int, column: int, gone: int, word: str) -> str:
    lines = text.split("\n")
    line = lines[at % len(lines)]
    lines[at % len(lines)] = line[:column] + word + line[column + gone :]
    return "\n".join(lines)


def told(document: Document | None, found: Any) -> Any:
    """Return all parts of a document, in its order."""
    known = document and (document.data, [*document.spans.items()], document.text, document.dropped)
    return known, found


def hold_for_documents(text: str, edits: list[tuple[int, int, int, str]]) -> None:
    with patch.dict(recollection._last, clear=True):
        parse("odd.yaml", text.encode())
        for edit in edits:
            content = edited(text, *edit).encode("utf-8", "surrogatepass")
            again = told(*parse("odd.yaml", content))
            with patch.dict(recollection._last, clear=True):
                assert again == told(*parse("odd.yaml", content))
            text = content.decode("utf-8", "surrogatepass") if again[0] else text


def hold_for_projects(edits: list[tuple[int, int, int, str]]) -> None:
    text = BASE[TOUR].decode()
    with patch.dict(recollection._last, clear=True):
        for edit in edits:
            text = edited(text, *edit)
            files = {**BASE, TOUR: text.encode("utf-8", "surrogatepass")}
            again = check_files(Path(), files)
            with patch.dict(recollection._last, clear=True):
                assert again == check_files(Path(), files)


@settings(max_examples=60)
@given(st.sampled_from([ODD, WHOLE]), EDITS)
def test_a_document_is_as_if_it_were_read_for_the_first_time(text: str, edits: list[tuple[int, int, int, str]]) -> None:
    hold_for_documents(text, edits)


@settings(max_examples=10)
@given(EDITS)
def test_findings_are_as_if_they_were_looked_for_the_first_time(edits: list[tuple[int, int, int, str]]) -> None:
    hold_for_projects(edits)


@pytest.mark.soak
@settings(max_examples=5_000)
@given(st.sampled_from([ODD, WHOLE]), EDITS)
def test_a_document_is_as_if_it_were_read_for_the_first_time_in_all_cases(
    text: str, edits: list[tuple[int, int, int, str]]
) -> None:
    hold_for_documents(text, edits)


@pytest.mark.soak
@settings(max_examples=500)
@given(EDITS)
def test_findings_are_as_if_they_were_looked_for_the_first_time_in_all_cases(
    edits: list[tuple[int, int, int, str]],
) -> None:
    hold_for_projects(edits)


@for_each(
    ("old", "new", "block"),
    [
        ("one: 1", "one: 12", "inner:"),
        ("b: [2, 3]", "b: [2]", "inner:"),
        ("- a: 1", "- a: 2", "other:"),
        ("deeper: yes", "deeper: no", "deep:"),
        ("# behind", "# before", "deep:"),
        ("of: it", "of: us", "end:"),
        ("one: 1", "one: 1\nmore: 2", ""),
        ("one: 1", "one: &a 1", ""),
        ("    one: 1", "  one: 1", ""),
        ("one: 1", "one: {", ""),
        ("plain: text", "plain: words", ""),
    ],
)
def test_only_the_block_around_a_change_is_read(old: str, new: str, block: str) -> None:
    before, _ = parse("odd.yaml", WHOLE.encode())
    assert before
    read: list[str] = []

    def reader(text: str, *given: Any) -> Any:
        read.extend(line.strip() for line in text.split("\n") if line.strip() and line.strip() != "outer:")
        return yaml_reader._block("odd.yaml", text, *given)

    found = reread(before, WHOLE.replace(old, new, 1), reader)
    assert (found is not None, *read[:1]) == ((True, block) if block else (False,))
