"""What a repository uses lint by: the hook of pre-commit, and the GitHub action."""

import re
import shutil
import sys
from pathlib import Path
from typing import Any

import pytest
import yaml

from lumen.loading.files import read_files
from tests.guarded import CompletedProcess, run_guarded

ROOT = Path(__file__).parents[2]
BASE = Path(__file__).parent / "base"
HOOK: dict[str, Any] = yaml.safe_load((ROOT / ".pre-commit-hooks.yaml").read_text())[0]
ACTION: dict[str, Any] = yaml.safe_load((ROOT / "action.yml").read_text())


@pytest.fixture
def repository(tmp_path: Path) -> Path:
    """A git repository with a project in a folder of it, `lumen` on its PATH."""
    shutil.copytree(BASE, tmp_path / "repository" / "stand")
    bin_folder = tmp_path / "bin"
    bin_folder.mkdir()
    lumen = bin_folder / "lumen"
    lumen.write_text(f'#!/bin/sh\nPYTHONPATH="{ROOT / "engine"}" exec "{sys.executable}" -m lumen "$@"\n')
    lumen.chmod(0o755)
    run_guarded(["git", "init", "-q", tmp_path / "repository"], check=True)
    return tmp_path / "repository"


def spoil(folder: Path) -> None:
    file = folder / "behaviors" / "tour.yaml"
    file.write_text(file.read_text().replace("onError: idle", "onError: idel"))


def shell(command: str, folder: Path, **environment: str) -> CompletedProcess[str]:
    tools = next(parent / "bin" for parent in folder.parents if (parent / "bin" / "lumen").is_file())
    environment["PATH"] = f"{tools}:/usr/bin:/bin"
    words = ["bash", "-c", command]
    return run_guarded(words, cwd=folder, env=environment, capture_output=True, text=True, timeout=60, check=False)


def test_the_hook_has_what_pre_commit_asks_for() -> None:
    assert {"id", "name", "entry", "language", "files"} <= HOOK.keys()
    assert HOOK["id"] == "lumen-lint"


def test_the_hook_runs_for_every_file_of_a_project_and_no_other() -> None:
    files = re.compile(HOOK["files"])
    shipped = list(read_files(ROOT))
    assert all(files.search(file) for file in shipped)
    assert all(files.search(f"stand/{file}") for file in shipped if not file.startswith("schemas"))
    assert not [file for file in ("README.md", "engine/lumen/bus.py", "docs/yaml.md", "a.yaml") if files.search(file)]


@pytest.mark.slow
def test_the_hook_passes_and_fails(repository: Path) -> None:
    project = repository / "stand"
    assert shell(HOOK["entry"], project).returncode == 0
    spoil(project)
    done = shell(HOOK["entry"], project)
    assert done.returncode == 1
    assert "behaviors/tour.yaml:28:14" in done.stdout
    assert "unknown-state" in done.stdout


@pytest.mark.slow
def test_the_action_annotates_at_the_word(repository: Path) -> None:
    steps = ACTION["runs"]["steps"]
    assert ACTION["runs"]["using"] == "composite"
    assert all("shell" in step for step in steps if "run" in step)
    assert set(ACTION["inputs"]) == {"project", "arguments", "python-version"}
    lint = steps[-1]["run"]
    assert shell(lint, repository, PROJECT="stand", ARGUMENTS="--strict").returncode == 0
    spoil(repository / "stand")
    done = shell(lint, repository, PROJECT="stand", ARGUMENTS="--strict")
    assert done.returncode == 1
    notes = [line for line in done.stdout.splitlines() if line.startswith("::error ")]
    assert len(notes) == 1
    for part in ("file=stand/behaviors/tour.yaml", "line=28", "col=14", "idel"):
        assert part in notes[0]


def test_the_action_takes_nothing_from_outside_into_its_commands() -> None:
    """What an input says reaches the shell as a variable only: `${{ … }}` in a command would be run."""
    assert not [step for step in ACTION["runs"]["steps"] if "${{" in step.get("run", "")]
