"""Counts that are printed: one is followed by the singular."""

from lumen.language.counts import counted
from lumen.project.schema import faults
from tests.tables import for_each


@for_each(
    "row",
    [
        ((1, "text"), "1 text"),
        ((0, "text"), "0 texts"),
        ((2000, "text"), "2,000 texts"),
        ((1, "entry", "entries"), "1 entry"),
        ((2, "entry", "entries"), "2 entries"),
    ],
    ids=str,
)
def test_a_count_has_its_noun(row: tuple[tuple[int, str], str]) -> None:
    assert counted(*row[0]) == row[1]


def test_a_message_counts_one_key_in_the_singular() -> None:
    [fault] = faults({"one": 1}, {"type": "object", "maxProperties": 0})
    assert "has 1 key, but" in fault.message
