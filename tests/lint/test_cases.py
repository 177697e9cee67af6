"""One mistake, or several, in a small project: exactly these findings, at the very word, with the right hint.

Each YAML file beside this one is a table of cases. A case changes the project in base/, or that in the folder of the
table's name: `edit` maps a file to [old, new, …], `write` to its whole content, `nest` to a word in it and the [before,
after, times] that replace it; `delete` lists the beginnings of paths. `find` lists all findings of lint, as
"file:line:column code | part of the hint", and " @ file:line:column" where another place is shown first; it must say
nothing else.
"""

from functools import partial
from pathlib import Path
from typing import Any

import pytest

from lumen.language.diagnostics import Diagnostic
from lumen.lint import check_files
from lumen.project.files import read_files
from lumen.project.yaml_reader import parse
from tests.lint.spans import assert_marks_what_is_spoken_of
from tests.scanning import matching
from tests.tables import check, for_each

HERE = Path(__file__).parent
BASES = {name: read_files(HERE / name) for name in ("base", "hearing")}
TABLES = matching(HERE, "*.yaml")


def cases(table: Path) -> dict[str, Any]:
    document, diagnostics = parse(table.name, table.read_bytes())
    assert document
    assert not diagnostics, diagnostics[0]
    return document.data


def changed(base: dict[str, bytes], case: dict[str, Any]) -> dict[str, bytes]:
    gone = tuple(case.get("delete", ()))
    files = {name: content for name, content in base.items() if not name.startswith(gone)} if gone else dict(base)
    for name, edits in case.get("edit", {}).items():
        for old, new in zip(edits[::2], edits[1::2], strict=True):
            text = files[name].decode()
            assert text.count(old) == 1, f"{old!r} stands {text.count(old)} times in {name}"
            files[name] = text.replace(old, new).encode()
    files |= {name: text.encode() for name, text in case.get("write", {}).items()}
    for name, (word, before, after, times) in case.get("nest", {}).items():
        files[name] = files[name].replace(word.encode(), (before * times + after * times).encode())
    return files


def said(diagnostic: Diagnostic) -> str:
    related = f" @ {diagnostic.related[0].place}" if diagnostic.related else ""
    return f"{diagnostic.place} {diagnostic.code} | {diagnostic.hint}{related}"


@for_each("name", BASES)
def test_the_project_the_cases_are_made_from_is_sound(name: str) -> None:
    project, diagnostics = check_files(HERE / name, BASES[name])
    assert project is not None
    assert not diagnostics


def test_there_are_many_cases() -> None:
    assert sum(len(cases(table)) for table in TABLES) >= 774


@pytest.mark.parametrize("table", TABLES, ids=lambda table: table.stem)
def test_a_mistake_is_found_at_its_word_and_what_is_marked_is_spoken_of(table: Path) -> None:
    """Each case is linted once; its findings and then its places are judged."""
    base = table.stem if table.stem in BASES else "base"
    check((name, partial(judge, base, case)) for name, case in cases(table).items())


def judge(base: str, case: dict[str, Any]) -> None:
    files = changed(BASES[base], case)
    project, diagnostics = check_files(HERE / base, files)
    found = [said(d) for d in diagnostics]
    for line, expected in zip(found, case["find"], strict=False):
        finding, _, related = expected.partition(" @ ")
        where, _, hint = finding.partition(" |")
        assert line.startswith(f"{where} | "), f"found {found}"
        assert hint.strip() in line.partition(" | ")[2], f"found {found}"
        assert related in line, f"found {found}"
    assert len(found) == len(case["find"]), f"found {found}"
    assert (project is None) == any(d.severity == "error" for d in diagnostics)
    for diagnostic in diagnostics:
        assert_marks_what_is_spoken_of(diagnostic, files)
