"""The tables of the names that each importer reads, lists or ignores."""

from scripts.format_tables import PAGE, written

from lumen.project.formats.importers import format_tables
from tests.tables import for_each


def test_the_docs_have_the_tables() -> None:
    page = PAGE.read_text("utf-8")
    assert page == written(page), "run `python scripts/format_tables.py`"


@for_each("format", format_tables())
def test_a_name_is_either_read_or_listed_or_meaningless(format: str) -> None:
    for place, known in format_tables()[format].items():
        parts = [set(known.read), set(known.lost), set(known.meaningless)]
        assert sum(map(len, parts)) == len(set().union(*parts)), place


@for_each("format", format_tables())
def test_each_reason_is_given(format: str) -> None:
    assert all(
        why for known in format_tables()[format].values() for why in (*known.lost.values(), *known.meaningless.values())
    )
