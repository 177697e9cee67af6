"""The text output of `lumen fleet log`."""

from lumen.cli.tables import table
from lumen.features.fleet.text import log_lines


def test_a_log_says_what_happened_when_and_what_was_counted_with_each_bundle() -> None:
    incident = {"robot": "itb/nao1", "kind": "fell", "text": "it fell", "at": 1_800_000_000}
    numbers = {"bundle": "a" * 64, "robots": 2, "hours": 8.0, "measures": {"falls": 0.5}}
    other = {"bundle": "b" * 64, "robots": 1, "hours": 0.5, "measures": {"errors": 0.25}}
    first, second, *rows = log_lines({"incidents": [incident], "kinds": {"fell": 1}, "numbers": [numbers, other]})
    assert (first, second) == ("2027-01-15T08:00:00Z  itb/nao1: fell: it fell", "fell: 1")
    assert [row.split() for row in "\n".join(rows).splitlines()] == [
        ["bundle", "robots", "hours", "errors", "falls"],
        ["aaaaaaaaaaaa", "2", "8.0", "-", "0.5"],
        ["bbbbbbbbbbbb", "1", "0.5", "0.25", "-"],
    ]
    assert list(log_lines({"incidents": [], "kinds": {}, "numbers": []})) == ["no incidents"]


def test_only_a_column_of_numbers_is_aligned_to_the_right() -> None:
    rows = [("nao1", "8.0", "3"), ("nao12", "12.5", "none"), ("nao3", "-", "5")]
    assert table(("robot", "hours", "falls"), rows).splitlines() == [
        "robot  hours  falls",
        "nao1     8.0  3",
        "nao12   12.5  none",
        "nao3       -  5",
    ]
