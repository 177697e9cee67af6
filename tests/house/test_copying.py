"""A copy of a project is the same on a machine where the project ran."""

from pathlib import Path

from lumen.project.project_folders import PROJECT_FOLDERS
from tests import ROOT
from tests.copying import copied_project


def test_a_copy_has_nothing_that_a_run_left(tmp_path: Path) -> None:
    for file in ("lumen.yaml", "behaviors/hello.yaml", ".lumen/journal/old.journal", "eyes/__pycache__/eyes.pyc"):
        (tmp_path / "hall" / file).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / "hall" / file).touch()
    for _ in range(2):
        copy = copied_project(tmp_path / "hall", tmp_path / "copy")
        assert [each.name for each in sorted(copy.rglob("*"))] == ["behaviors", "hello.yaml", "eyes", "lumen.yaml"]


def test_a_copy_of_the_shipped_project_has_nothing_else_of_the_repository(tmp_path: Path) -> None:
    copy = copied_project(ROOT, tmp_path / "tour")
    found = {each.name for each in copy.iterdir()}
    assert {"lumen.yaml", "behaviors", "motions"} <= found <= {"lumen.yaml", *PROJECT_FOLDERS}
