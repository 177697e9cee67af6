"""98 of 100 common mistakes are reported once, at the line, with advice; correct projects have no findings."""

from functools import cache

import pytest

from lumen.lint import check_files
from tests.mistakes.__main__ import told
from tests.mistakes.linted import findings
from tests.mistakes.rows import PROJECTS, Row, rows, shipped
from tests.mistakes.scores import Judged, judge, score
from tests.tables import for_each

pytestmark = [pytest.mark.rest, pytest.mark.xdist_group("mistakes")]  # expensive; one lint serves the golden as well


@cache
def judged() -> tuple[Judged, ...]:
    return tuple(judge(row) for row in rows("table"))


@pytest.mark.parametrize("project", PROJECTS)
def test_nothing_is_said_of_what_is_shipped(project: str) -> None:
    assert check_files(PROJECTS[project], shipped(project))[1] == ()


def test_mistakes_are_told_where_they_are_with_what_to_do_and_once() -> None:
    found = score(judged())
    wrong = "\n".join(told(j) for j in judged() if not (j.placed and j.named and j.single))
    assert found.rows >= 150
    assert min(found.percent()) >= 98, wrong


@for_each("row", list(rows("skills")), ids=lambda row: row.name)
def test_mistakes_with_skills_are_told_where_they_are_with_what_to_do_and_once(row: Row) -> None:
    found = judge(row)
    assert (found.placed, found.named, found.single) == (True, True, True), told(found)


def test_there_are_many_mistakes_with_skills() -> None:
    assert sum(1 for _ in rows("skills")) >= 40


@for_each("row", list(rows("legal")), ids=lambda row: row.name)
def test_nothing_is_said_of_what_is_right(row: Row) -> None:
    assert [str(d) for d in findings(row.root, row.files)] == []


def test_there_are_many_rows() -> None:
    names = [row.name for row in rows("table")]
    assert len(set(names)) == len(names) >= 150
    assert sum(1 for _ in rows("legal")) >= 60
