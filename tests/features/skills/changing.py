"""A small project with a skill, for the tests of this folder: changed, and linted."""

from collections.abc import Mapping
from pathlib import Path

from lumen.language.diagnostics import Diagnostic
from lumen.lint import check_files
from lumen.project.files import read_files
from tests import ROOT
from tests.copying import copied_project

HERE = ROOT / "tests/features/skills"

MANIFEST, CODE, BEHAVIOR = "skills/spray.yaml", "skills/spray.py", "behaviors/fog.yaml"
STORY = "behaviors/stories/visitor.yaml"


def project_in(folder: Path, changes: Mapping[str, tuple[str, str]] | None = None) -> Path:
    """Copy the project, replace one text in each of some of its files, and return its folder."""
    root = copied_project(HERE / "project", folder)
    for file, (old, new) in (changes or {}).items():
        text = (root / file).read_text("utf-8") if old else ""
        assert old in text, f"{old!r} is not in {file}"
        (root / file).parent.mkdir(parents=True, exist_ok=True)
        (root / file).write_text(text.replace(old, new, 1) if old else new, "utf-8")
    return root


def lint(root: Path) -> list[Diagnostic]:
    """Return the findings of a project."""
    return list(check_files(root, read_files(root))[1])


def found(root: Path) -> list[str]:
    """Return the findings of a project, each in a line: place, code, message and hint."""
    return [f"{each.place} {each.code} | {each.message} | {each.hint}" for each in lint(root)]
