"""Lint resolves paths to the same places as Python, which asks about each folder anew."""

import os
from pathlib import Path

import pytest

from lumen.project.looks import Looks
from lumen.project.misplaced import Misnamed, misnamed_in
from tests.tables import for_each


@pytest.fixture
def project(tmp_path: Path) -> Path:
    """A project with links to a file and a folder in it, out of it, to nothing, and in a circle."""
    root = tmp_path / "project"
    (root / "motions").mkdir(parents=True)
    (root / "motions/wave.YAML").write_text("")
    (tmp_path / "outside").mkdir()
    (tmp_path / "outside/bow.YAML").write_text("")
    links = {
        "file": "motions/wave.YAML",
        "inside": "motions",
        "fuzzy": "../outside",
        "nothing": "gone",
        "circle": "circle",
    }
    for name, target in links.items():
        (root / name).symlink_to(target)
    return root


@for_each(
    "path",
    [
        "", "motions", "motions/wave.YAML", "motions/gone.yaml", "gone/far/away", "file", "inside", "inside/wave.YAML",
        "fuzzy", "fuzzy/bow.YAML", "fuzzy/../project", "nothing", "circle", "circle/wave.YAML", "motions/../file",
    ],
)  # fmt: skip
def test_a_path_leads_to_the_same_place(project: Path, path: str) -> None:
    looks = Looks()
    assert [looks.at(project / path), looks.at(project / path)] == [os.path.realpath(project / path)] * 2


def test_a_relative_path_leads_to_the_same_place(project: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(project)
    assert Looks().at(Path("inside/wave.YAML")) == os.path.realpath("motions/wave.YAML")


def test_a_name_that_no_file_can_have_leads_nowhere(project: Path) -> None:
    assert Looks().at(project / "a\0b") == ""


def test_files_are_misnamed_in_folders_of_the_project_only(project: Path) -> None:
    assert list(misnamed_in(project, "motions")) == [Misnamed("motions/wave.YAML", "motions/wave.yaml")]
    assert list(misnamed_in(project, "fuzzy")) == []  # a link out of it
    assert list(misnamed_in(project, "gone")) == []
