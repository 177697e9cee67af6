"""The project that a command uses: one that checks a project never falls back to the shipped one."""

from pathlib import Path

import pytest

from lumen.cli.main import main
from lumen.project.running_project import own_project, projects_below

JUDGING = [["lint"], ["lint", "--fix"], ["test"], ["test", "visitor"], ["diff", "live"], ["doctor"], ["alerts", "test"]]


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty folder, the current directory."""
    monkeypatch.chdir(tmp_path)
    return tmp_path


def a_project(folder: Path) -> Path:
    folder.mkdir(parents=True)
    (folder / "lumen.yaml").write_text("name: Mine\n")
    return folder


@pytest.mark.parametrize("words", JUDGING, ids=" ".join)
def test_without_a_project_nothing_is_judged(words: list[str], here: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(words) == 2
    said = f"there is no lumen.yaml in {here} or above: pass the folder of a project, or make one with `lumen new DIR`"
    assert capsys.readouterr() == ("", f"lumen {words[0]}: {said}\n")


@pytest.mark.parametrize("words", [*JUDGING, ["lint", "."], ["test", "."], ["doctor", "."], ["alerts", "test", "."]])
def test_those_below_are_named(words: list[str], here: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for folder in ("exhib", "halls/second", "halls/first"):
        a_project(here / folder)
    assert main(words) == 2
    said = capsys.readouterr().err
    assert said.endswith("pass the folder of one of these projects: `exhib`, `halls/first`, `halls/second`\n")


def test_the_project_above_is_ones_own(here: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    inside = a_project(here / "exhib") / "behaviors" / "stories"
    inside.mkdir(parents=True)
    monkeypatch.chdir(inside)
    assert own_project() == here / "exhib"
    assert own_project(here / "exhib") == own_project(here / "exhib" / "lumen.yaml") == here / "exhib"


def test_what_is_hidden_installed_or_within_a_project_is_not_seen(here: Path) -> None:
    for folder in (".venv/a", "node_modules/b", "one", "one/two"):
        a_project(here / folder)
    (here / "loop").symlink_to(here)
    assert list(projects_below(here)) == [here / "one"]


def test_who_only_shows_something_shows_the_shipped_project_and_says_so(
    here: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["export", "mermaid"]) == 0
    out, err = capsys.readouterr()
    assert out.startswith("stateDiagram-v2")
    assert err.startswith("There is no lumen.yaml here or above: this is the shipped project, ")
