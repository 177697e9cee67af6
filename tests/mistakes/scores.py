"""Lint's findings for a row, and the number of rows with the right finding."""

from collections.abc import Iterable
from typing import NamedTuple

from lumen.language.diagnostics import Diagnostic
from tests.mistakes.linted import findings
from tests.mistakes.rows import Row


class Judged(NamedTuple):
    """A row, lint's findings, and whether they are at the line, name the remedy, and are only one."""

    row: Row
    found: tuple[Diagnostic, ...]
    placed: bool
    named: bool
    single: bool


class Score(NamedTuple):
    """The numbers of rows with a finding at its line, with the remedy, and with only one finding; `rows` are all of
    them.
    """

    placed: int
    named: int
    single: int
    rows: int

    def percent(self) -> tuple[float, float, float]:
        return 100 * self.placed / self.rows, 100 * self.named / self.rows, 100 * self.single / self.rows


def judge(row: Row) -> Judged:
    """Return the row with lint's findings, and whether one is at the line and names the remedy, and is the only one."""
    found = findings(row.root, row.files)
    here = [d for d in found if d.place.file == row.file and d.place.line == row.line]
    named = any(words.lower() in f"{d.message} {d.hint}".lower() for d in here for words in row.says)
    return Judged(row, found, bool(here), named, len(found) == 1)


def score(judged: Iterable[Judged]) -> Score:
    several = list(judged)
    return Score(
        sum(j.placed for j in several), sum(j.named for j in several), sum(j.single for j in several), len(several)
    )
