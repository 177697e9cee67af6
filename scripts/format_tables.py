"""Generate the last part of docs/formats.md from the importers' tables: `python scripts/format_tables.py`."""

import sys
from collections.abc import Iterable, Mapping
from pathlib import Path

from lumen.project.formats.importers import format_tables
from lumen.project.formats.known import FormatTable, Known

PAGE = Path(__file__).parents[1] / "docs/formats.md"
HEADING = "## Names that the import reads, lists or ignores\n"
_INTRODUCTION = """
`scripts/format_tables.py` generates these tables from the tables of the importers. Each row has the names that can
occur in one place of a file. The import also lists names that are in no table, and values that it does not read. To
check this, `python -m tests.attack --imports 2000` changes files at random and reports each change that is lost
without a finding.
"""


def written(page: str) -> str:
    """Return the page with its last part generated from the current tables."""
    tables = "".join(f"\n### {name}\n\n{_table(table)}" for name, table in format_tables().items())
    return f"{page.partition(HEADING)[0].rstrip()}\n\n{HEADING}{_INTRODUCTION}{tables}"


def _table(table: FormatTable) -> str:
    rows = "".join(f"| {_code([place])} | {_row(known)} |\n" for place, known in table.items())
    return f"| place | read | listed | ignored |\n| --- | --- | --- | --- |\n{rows}"


def _row(known: Known) -> str:
    return " | ".join((_code(sorted(known.read)), _reasons(known.lost), _reasons(known.meaningless)))


def _reasons(names: Mapping[str, str]) -> str:
    by_reason: dict[str, list[str]] = {}
    for name, reason in names.items():
        by_reason.setdefault(reason, []).append("all" if name == "…" else name)
    return "; ".join(f"{_code(group)}: {reason}" for reason, group in by_reason.items()).replace("|", "\\|")


def _code(names: Iterable[str]) -> str:
    """Return the names as inline code, except descriptions of a place."""
    return ", ".join(name if " " in name and "`" in name else f"`{name}`" for name in names)


def main() -> None:
    PAGE.write_text(written(PAGE.read_text(encoding="utf-8")), encoding="utf-8")
    print(f"wrote the tables of {len(format_tables())} formats to {PAGE.name}", file=sys.stderr)


if __name__ == "__main__":
    main()
