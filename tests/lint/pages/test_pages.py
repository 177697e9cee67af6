"""Every code has a page; docs/rules/ is what the pages say.

Lint finds in a wrong example what its page is about, at the marked word and nothing else, and nothing in a right one.
"""

import pytest
from scripts.rule_pages import BASE, DOCS, said, written

from lumen.loading.files import read_files
from lumen.rules import check_files
from lumen.rules.codes import CODES, FAMILIES
from lumen.rules.pages import _HERE, page

PLAYED = [pytest.mark.physics, pytest.mark.xdist_group("pages")]
"""Examples that the simulated robot plays: once, in one worker, since what lint says of them is kept."""
MARKS = {**dict.fromkeys(FAMILIES["physics"], PLAYED), "too-large": [pytest.mark.slow]}


def test_the_project_below_the_examples_is_sound() -> None:
    assert check_files(BASE, read_files(BASE))[1] == ()


def test_every_code_has_a_page_and_every_page_a_code() -> None:
    assert {file.stem for file in _HERE.glob("*.md")} == CODES.keys()


@pytest.mark.parametrize("code", [pytest.param(code, marks=MARKS.get(code, ())) for code in CODES])
def test_a_wrong_example_has_its_finding_at_the_marked_word_and_the_right_one_none(code: str) -> None:
    wrong, right = page(code).wrong, page(code).right
    (marked,) = [sheet for sheet in wrong if sheet.mark]
    line, first, last = marked.mark or (0, 0, 0)
    found = [d for d in said(wrong) if d.code == code]
    assert [d.code for d in said(wrong)] == [code]
    assert (found[0].place.file, found[0].place.line, found[0].place.column) == (marked.file, line, first)
    assert found[0].place.end_column == last or found[0].place.end_line > line
    assert said(right) == []


@pytest.mark.parametrize("code", CODES)
def test_a_page_says_what_and_why_in_few_words(code: str) -> None:
    found = page(code)
    assert found.what.endswith(".")
    assert found.why.endswith(".")
    assert len(found.what) + len(found.why) < 900
    assert found.right


@pytest.mark.physics
@pytest.mark.xdist_group("pages")
def test_the_docs_are_what_the_pages_say() -> None:
    there = {file.name: file.read_text(encoding="utf-8") for file in DOCS.glob("*.md")}
    assert there == written(), "run `python scripts/rule_pages.py`"
