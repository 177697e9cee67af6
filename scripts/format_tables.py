"""Writes the last part of docs/formats.md from the tables of the importers: `python scripts/format_tables.py`."""

import sys
from collections.abc import Iterable, Mapping
from pathlib import Path

from lumen.formats.known import FormatTable, Known
from lumen.formats.tables import TABLES

PAGE = Path(__file__).parents[1] / "docs/formats.md"
HEADING = "## What is read, listed, or without meaning\n"
_INTRODUCTION = """
Written by `scripts/format_tables.py` from the tables that the importers read by. A name that a table does not have is
listed at its place, as are values that are not read; `python -m tests.attack --imports 2000` changes files at random
and looks for what is lost without a finding.
"""


def written(page: str) -> str:
    """The page with its last part as the tables are now."""
    tables = "".join(f"\n### {name}\n\n{_table(table)}" for name, table in TABLES.items())
    return f"{page.partition(HEADING)[0].rstrip()}\n\n{HEADING}{_INTRODUCTION}{tables}"


def _table(table: FormatTable) -> str:
    rows = "".join(f"| {_code([place])} | {_row(known)} |\n" for place, known in table.items())
    return f"| in | read | listed | without meaning |\n| --- | --- | --- | --- |\n{rows}"


def _row(known: Known) -> str:
    return " | ".join((_code(sorted(known.read)), _reasons(known.lost), _reasons(known.meaningless)))


def _reasons(names: Mapping[str, str]) -> str:
    by_reason: dict[str, list[str]] = {}
    for name, reason in names.items():
        by_reason.setdefault(reason, []).append("all" if name == "…" else name)
    return "; ".join(f"{_code(group)}: {reason}" for reason, group in by_reason.items()).replace("|", "\\|")


def _code(names: Iterable[str]) -> str:
    """The names as code, but for words that describe a place and `all`."""
    return ", ".join(name if " " in name and "`" in name else f"`{name}`" for name in names)


def main() -> None:
    PAGE.write_text(written(PAGE.read_text(encoding="utf-8")), encoding="utf-8")
    print(f"wrote the tables of {len(TABLES)} formats to {PAGE.name}", file=sys.stderr)


if __name__ == "__main__":
    main()
