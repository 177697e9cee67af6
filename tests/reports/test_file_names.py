"""Names of files and folders that are nearly right, closed or written as a Mac does: each is found or reported."""

import contextlib
import errno
import io
import os
import unicodedata
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest

from lumen import check, load
from lumen.cli.main import main
from lumen.errors import ProjectError
from lumen.lint import check_files
from lumen.project.files import fingerprint, read_files
from tests.reports.small_project import MINIMAL, MISSPELT, STATES, TOUR, WAVE, placed, project
from tests.tables import for_each


def small(root: Path) -> Path:
    """Write a small project to the disk; its behaviour plays a motion."""
    return placed(root, read_files(MINIMAL))


def findings(root: Path) -> list[str]:
    return [f"{d.place.file}:{d.place.line} {d.code} | {d.hint}" for d in check(root)]


@for_each(
    ("old", "new", "expected"),
    [
        ("motions/wave.yaml", "motions/wave.yaml.txt", "motions/wave.yaml.txt to motions/wave.yaml"),
        ("motions/wave.yaml", "motions/wave.YAML", "motions/wave.YAML to motions/wave.yaml"),
        ("motions/wave.yaml", "motions/wave.Yml", "motions/wave.Yml to motions/wave.yaml"),
        ("motions/wave.yaml", "motions/Wave.yaml .txt", "motions/Wave.yaml .txt to motions/Wave.yaml"),
        ("motions", "Motions", "Motions/ to motions/"),
        ("behaviors/hello.yaml", "behaviors/hello.yaml.text", "behaviors/hello.yaml.text to behaviors/hello.yaml"),
        ("behaviors/stories", "behaviors/Stories", "behaviors/Stories/ to behaviors/stories/"),
    ],
)
def test_a_file_whose_name_is_nearly_right_is_named(old: str, new: str, expected: str) -> None:
    with TemporaryDirectory() as folder:
        root = small(Path(folder))
        (root / old).rename(root / new)
        told = findings(root)
        assert any(each.endswith(f" | rename {expected}") for each in told), told
        meant = expected.partition(" to ")[2]
        assert f"{new}:1 not-read | rename it to {meant if meant.endswith('/') else Path(meant).name}" in told


def test_a_copy_in_the_same_folder_is_not_part_of_the_project(tmp_path: Path) -> None:
    root = small(tmp_path)
    for copy in ("motions/wave.yaml.txt", "motions/wave.YAML", "motions/notes.txt", "motions/.wave.yaml.txt"):
        (root / copy).write_text("a")
    assert findings(root) == []


@for_each("name", ["lumen.yml", "Lumen.yaml", "lumen.yaml.txt", "lumen.YAML"])
@for_each("command", [["lint"], ["lint", "."], ["run", "--story", "visitor"], ["doctor"], ["graph"]])
def test_a_main_file_under_another_name_is_named(name: str, command: list[str]) -> None:
    with TemporaryDirectory() as folder, contextlib.chdir(folder):
        root = small(Path(folder))
        (root / "lumen.yaml").rename(root / name)
        told = io.StringIO()
        with contextlib.redirect_stderr(told), contextlib.redirect_stdout(told):
            assert main(command) != 0
        assert f"rename {name} to lumen.yaml" in told.getvalue()


def test_a_folder_elsewhere_shows_no_names(tmp_path: Path) -> None:
    root = small(tmp_path / "project")
    (tmp_path / "secrets").mkdir()
    (tmp_path / "secrets" / "tops3cret.yaml.txt").write_text("a")
    (root / "fuzzy").symlink_to(tmp_path / "secrets")
    hint = "replace it with a folder inside the project: Lumen reads nothing outside the project"
    assert findings(root) == [f"fuzzy:1 unreadable-file | {hint}"]


def closed(monkeypatch: pytest.MonkeyPatch, folder: Path) -> None:
    """Let the system refuse to list that folder, as `chmod 000` does for all users except root."""
    listdir = os.listdir

    def refuse(path: Path | str = ".") -> list[str]:
        if Path(path) == folder:
            raise PermissionError(errno.EACCES, os.strerror(errno.EACCES), str(path))
        return listdir(path)

    monkeypatch.setattr(os, "listdir", refuse)


@pytest.mark.parametrize("folder", ["knowledge", "motions", "behaviors/stories", "behaviors", "motions/life", "models"])
def test_a_folder_that_can_not_be_read_is_not_an_empty_one(
    folder: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    root = small(tmp_path)
    (root / folder).mkdir(exist_ok=True)
    closed(monkeypatch, root / folder)
    told = findings(root)
    assert f"{folder}:1 unreadable-file | make it a readable folder, or delete it" in told
    assert not [each for each in told if "missing" in each], told
    with pytest.raises(ProjectError, match="this can't be read: permission denied"):
        load(root)


@for_each("folder", ["stories", "words"])
def test_a_closed_folder_outside_the_project_is_ignored(folder: str) -> None:
    with TemporaryDirectory() as name, pytest.MonkeyPatch.context() as patch:
        root = small(Path(name))
        (root / folder).mkdir()
        closed(patch, root / folder)
        assert findings(root) == []


def test_a_closed_folder_is_a_change_that_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    root = small(tmp_path)
    (root / "knowledge").mkdir()
    (root / "knowledge" / "hours.md").write_text("# Opening hours\n\nWe are open from nine to five.\n")
    here = read_files(root)
    closed(monkeypatch, root / "knowledge")
    there = read_files(root)
    assert fingerprint(there) != fingerprint(here)
    project, diagnostics = check_files(root, there)
    assert project is None
    assert [(d.code, d.place.file) for d in diagnostics] == [("unreadable-file", "knowledge")]


CAFE = "caf\u00e9"
DECOMPOSED = unicodedata.normalize("NFD", CAFE)


def french(root: Path, name: str) -> Path:
    """Write the small project with the motion `café` instead of `wave`, in a file called `name`."""
    small(root)
    (root / WAVE).rename(root / "motions" / f"{name}.yaml")
    for file in root.rglob("*.yaml"):
        text = file.read_text().replace("play: wave", f"play: {CAFE}")
        file.write_text(text.replace("played: wave", f"played: {CAFE}"))
    return root


def test_a_file_name_of_a_mac_is_found(tmp_path: Path) -> None:
    there, root = french(tmp_path / "a", CAFE), french(tmp_path / "b", DECOMPOSED)
    assert findings(root) == []
    assert list(load(root).motions) == [CAFE]
    assert load(root).hash == load(there).hash
    assert main(["lint", str(root / "motions" / f"{DECOMPOSED}.yaml")]) == 0


@pytest.mark.process
def test_a_motion_with_a_file_name_of_a_mac_is_plotted(tmp_path: Path) -> None:
    root = french(tmp_path, DECOMPOSED)
    assert main(["plot", f"{root}/motions/{DECOMPOSED}.yaml", "-o", str(tmp_path / "a.svg")]) == 0


def test_a_repair_is_written_into_the_file_of_a_mac(tmp_path: Path) -> None:
    root = placed(tmp_path, project("tour.yaml", MISSPELT))
    file = root / "behaviors" / f"{DECOMPOSED}.yaml"
    (root / TOUR).rename(file)
    (root / "lumen.yaml").write_text((root / "lumen.yaml").read_text().replace("behavior: tour", f"behavior: {CAFE}"))
    before = sorted(root.rglob("*.yaml"))
    assert main(["lint", "--fix", str(root)]) == 0
    assert file.read_bytes() == STATES.encode()
    assert sorted(root.rglob("*.yaml")) == before


def test_one_of_two_files_with_the_same_name_is_reported(tmp_path: Path) -> None:
    root = french(tmp_path, DECOMPOSED)
    (root / "motions" / f"{CAFE}.yaml").write_bytes((root / "motions" / f"{DECOMPOSED}.yaml").read_bytes())
    if len(list((root / "motions").iterdir())) == 1:
        pytest.skip("this file system holds one file of that name")
    [told] = findings(root)
    assert told.endswith("not-read | combine them, or rename one of them")
