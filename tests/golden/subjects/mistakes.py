"""Everything that lint finds in a frozen copy of the table of mistakes, and in what looks odd and is right."""

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from tests.golden.adapters_language import project_files, table
from tests.golden.found import write_findings
from tests.golden.golden import HERE, PROJECTS, SHIPPED
from tests.mistakes.linted import findings

SUITE = "rest"
"""It lints the tour 300 times: 20 s of processor time."""
GROUP = "mistakes"
"""The tests of one worker that share these lints: tests/mistakes has most of the rows, too."""
MISTAKES = HERE / "mistakes"


def record(folder: Path) -> None:
    """Write the findings of each row, and their words."""
    assert write_findings(folder, inputs(), findings) > 300


def inputs() -> Iterator[tuple[str, Path, Mapping[str, bytes]]]:
    """Yield the name, root and files of each project to lint."""
    shipped = {name: project_files(PROJECTS / name) for name in SHIPPED}
    for file in sorted(MISTAKES.glob("*/*.yaml")):
        for name, row in table(file).items():
            if row["in"] not in SHIPPED:
                continue  # a row of a project that came later
            yield f"{file.parent.name}/{file.stem}: {name}", PROJECTS / row["in"], changed(shipped[row["in"]], row)


def changed(shipped: Mapping[str, bytes], row: Mapping[str, Any]) -> dict[str, bytes]:
    """Return the files of a row, as the docstring of tests/mistakes/rows.py describes it."""
    files = dict(shipped)
    if "change" in row:
        file = row.get("file", f"behaviors/{row['in']}.yaml")
        text, (old, new) = files[file].decode(), row["change"]
        place = text.index(old, text.index(row["after"]) if "after" in row else 0)
        files[file] = (text[:place] + new + text[place + len(old) :]).encode()
    return files | {name: text.encode() for name, text in row.get("write", {}).items()}
