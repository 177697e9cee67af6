"""Everything that lint finds in frozen copies of its cases, and in the frozen projects."""

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from tests.golden.adapters_language import project_files, table
from tests.golden.found import write_findings
from tests.golden.golden import HERE, PROJECTS, SHIPPED

SUITE = "test"
CASES = HERE / "lint_cases"


def record(folder: Path) -> None:
    """Write the findings of each case, and their words."""
    assert write_findings(folder, inputs()) > 600


def inputs() -> Iterator[tuple[str, Path, Mapping[str, bytes]]]:
    """Yield the name, root and files of each project to lint."""
    base = project_files(CASES / "base")
    for file in sorted(CASES.glob("*.yaml")):
        for name, case in table(file).items():
            yield f"{file.stem}: {name}", CASES / "base", changed(base, case)
    for name in SHIPPED:
        yield f"project {name}", PROJECTS / name, project_files(PROJECTS / name)


def changed(base: Mapping[str, bytes], case: Mapping[str, Any]) -> dict[str, bytes]:
    """Return the files of a case, as the docstring of tests/lint/test_cases.py describes it."""
    gone = tuple(case.get("delete", ()))
    files = {name: content for name, content in base.items() if not (gone and name.startswith(gone))}
    for name, edits in case.get("edit", {}).items():
        for old, new in zip(edits[::2], edits[1::2], strict=True):
            assert files[name].count(old.encode()) == 1, f"{old!r} is not once in {name}"
            files[name] = files[name].replace(old.encode(), new.encode())
    files |= {name: text.encode() for name, text in case.get("write", {}).items()}
    for name, (word, before, after, times) in case.get("nest", {}).items():
        files[name] = files[name].replace(word.encode(), (before * times + after * times).encode())
    return files
