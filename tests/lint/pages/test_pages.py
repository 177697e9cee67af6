"""Every code has a page, and docs/rules/ has the content of the pages.

Lint finds in a wrong example what its page is about, at the marked word and nothing else, and nothing in a right one.
"""

from importlib.resources import files
from pathlib import Path

import pytest
from scripts.rule_pages import BASE, DOCS, said, written

from lumen.feature import rows
from lumen.lint import check_files
from lumen.lint.codes import codes, families
from lumen.lint.pages import page
from lumen.project.files import read_files
from tests.scanning import matching
from tests.tables import for_each

pytestmark = pytest.mark.xdist_group("pages")
"""One worker for the whole file: what lint reports of an example is kept for the next test."""
PLAYED = families()["physics"]
"""Codes whose examples the simulated robot plays."""
SLOW = "too-large"


def test_the_project_below_the_examples_is_sound() -> None:
    assert check_files(BASE, read_files(BASE))[1] == ()


def test_every_code_has_a_page_and_every_page_a_code() -> None:
    packages = [package for _, package in rows("pages")]
    assert len(packages) > 3
    pages = [file.stem for package in packages for file in matching(Path(str(files(package))), "*.md")]
    assert sorted(pages) == sorted(codes())


def judge(code: str) -> None:
    """Assert that lint finds in the wrong example its code at the marked word, and nothing in the right one."""
    wrong, right = page(code).wrong, page(code).right
    (marked,) = [sheet for sheet in wrong if sheet.mark]
    line, first, last = marked.mark or (0, 0, 0)
    found = [d for d in said(wrong) if d.code == code]
    assert [d.code for d in said(wrong)] == [code]
    assert (found[0].place.file, found[0].place.line, found[0].place.column) == (marked.file, line, first)
    assert found[0].place.end_column == last or found[0].place.end_line > line
    assert said(right) == []


@for_each("code", [code for code in codes() if code not in PLAYED and code != SLOW])
def test_a_wrong_example_has_its_finding_at_the_marked_word_and_the_right_one_none(code: str) -> None:
    judge(code)


@pytest.mark.slow
def test_so_has_the_example_that_is_too_large() -> None:
    judge(SLOW)


@pytest.mark.physics
@for_each("code", PLAYED)
def test_so_have_examples_that_the_simulated_robot_plays(code: str) -> None:
    judge(code)


@for_each("code", codes())
def test_a_page_says_what_and_why_in_few_words(code: str) -> None:
    found = page(code)
    assert found.what.endswith(".")
    assert found.why.endswith(".")
    assert len(found.what) + len(found.why) < 900
    assert found.right


@pytest.mark.physics
def test_the_docs_are_what_the_pages_say() -> None:
    there = {file.name: file.read_text(encoding="utf-8") for file in matching(DOCS, "*.md")}
    assert there == written(), "run `python scripts/rule_pages.py`"
