"""Version control ignores the contents of `.lumen/`, whichever part of Lumen made the folder."""

import re
from pathlib import Path

import pytest

from lumen.cli.main import main
from lumen.features.visitors.module import Store
from lumen.project.home import Home
from lumen.robot.deduplication_log import DeduplicationLog
from lumen.upkeep.own_folders import private_folder
from tests import ROOT
from tests.guarded import run_guarded
from tests.provided import program
from tests.scanning import matching

ENGINE = ROOT / "engine/lumen"
MAKERS = {
    "upkeep/own_folders.py": "the one function; and the user's own cache, which is not in a project",
    "run/new_passage.py": "knowledge/ of the project, which is to be committed",
    "features/console/kept_stories.py": "behaviors/stories/ of the project, which is to be committed",
    "run/new_saying.py": "behaviors/sayings/ of the project, which is to be committed",
    "features/simulation/trials/outcome_cache.py": "a folder within a private one",
    "run/workers/tasks.py": "a temporary folder",
    "run/reload/restoring.py": "folders of a project that is rolled back or updated, and one within a private one",
    "run/templates.py": "a folder of the project, for git",
    "features/skills/new_skill.py": "skills/ of the project, for git",
    "run/starting.py": "a project, which is to be committed",
    "project/running_project.py": "the shipped exhibition, in the state folder",
    "cli/writing.py": "where the user says",
    "features/simulation/shells.py": "the robot's shape",
}
"""The modules that may call `mkdir`, each with the reason why that exposes no private data to version control."""


def staged(folder: Path) -> str:
    """Return the files of a folder that `git add -A` adds, one per line."""
    run_guarded([program("git"), "init", "-q", folder], check=True)
    run_guarded(["git", "add", "-A"], cwd=folder, check=True)
    return str(run_guarded(["git", "ls-files"], cwd=folder, check=True, capture_output=True, text=True).stdout)


@pytest.mark.parametrize("first", ["home", "memory", "commands"])
def test_git_takes_nothing_of_it_whoever_comes_first(first: str, tmp_path: Path) -> None:
    folder = tmp_path / ".lumen"
    match first:
        case "home":
            home = Home(folder)
            home.hold()
            home.write("door.json", b"{}")
            home.release()
        case "memory":
            Store(folder / "memory.db").visitors()
        case "commands":
            DeduplicationLog(folder / "commands.jsonl").note("1", "desk")
    assert len(list(folder.iterdir())) >= 2
    assert staged(tmp_path) == ""


def test_after_a_run_git_takes_only_the_project(copy: Path) -> None:
    before = staged(copy)
    main(["run", str(copy), "--robot", "recording", "--speed", "max", "--for", "1s"])
    assert (copy / ".lumen").is_dir()
    assert staged(copy) == before


def test_a_folder_of_before_is_mended_and_what_somebody_wrote_stays(tmp_path: Path) -> None:
    (tmp_path / "faces.npz").touch()
    private_folder(tmp_path)
    assert (tmp_path / ".gitignore").read_text().endswith("\n*\n")
    (tmp_path / ".gitignore").write_text("*.db\n")
    private_folder(tmp_path)
    assert (tmp_path / ".gitignore").read_text() == "*.db\n"


def test_nobody_else_makes_a_folder_that_stays() -> None:
    made = {
        path.relative_to(ENGINE).as_posix()
        for path in matching(ENGINE, "**/*.py")
        if re.search(r"\.mkdir\(|makedirs\(", path.read_text())
    }
    assert made == MAKERS.keys()
