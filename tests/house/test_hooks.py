"""The hooks of pre-commit run programs of .venv, fetch nothing, and stop commits against the style."""

import shutil
import sys
from pathlib import Path
from typing import Any

import pytest
from pre_commit.clientlib import load_config

from tests import ROOT
from tests.guarded import CompletedProcess, run_guarded
from tests.provided import program
from tests.waiting import HANG

CONFIG = ROOT / ".pre-commit-config.yaml"


def hooks() -> dict[str, dict[str, Any]]:
    """Return each hook by its id, as pre-commit reads it."""
    (local,) = load_config(str(CONFIG))["repos"]
    assert local["repo"] == "local"
    return {hook["id"]: hook for hook in local["hooks"]}


def test_hooks_are_programs_of_the_environment_and_fetch_nothing() -> None:
    read = hooks()
    assert list(read) == ["ruff-check", "ruff-format", "floors", "order", "goldens", "lumen-lint"]
    for hook in read.values():
        program_of_venv, *words = hook["entry"].split()
        assert (Path(sys.prefix) / program_of_venv.removeprefix(".venv/")).is_file(), hook["id"]
        assert not [word for word in words if word.endswith(".py") and not (ROOT / word).is_file()]
        assert not hook.get("additional_dependencies")
        assert hook["language"] in ("system", "unsupported")


@pytest.fixture
def checkout(tmp_path: Path) -> Path:
    """A repository with our hooks and settings, and the environment that runs the tests as its .venv."""
    folder = tmp_path / "checkout"
    folder.mkdir()
    for file in (CONFIG, ROOT / "pyproject.toml"):
        shutil.copy(file, folder)
    (folder / ".venv").symlink_to(sys.prefix)
    (folder / ".gitignore").write_text(".venv\n")
    run_guarded([program("git"), "init", "-q"], cwd=folder, check=True)
    return folder


def run(hook: str, checkout: Path) -> "CompletedProcess[str]":
    run_guarded([program("git"), "add", "."], cwd=checkout, check=True)
    cache = {"PRE_COMMIT_HOME": str(checkout.parent / "cache"), "HOME": str(checkout.parent), "PATH": "/usr/bin:/bin"}
    words = [sys.executable, "-m", "pre_commit", "run", hook]
    return run_guarded(words, cwd=checkout, env=cache, capture_output=True, text=True, timeout=HANG, check=False)


@pytest.mark.parametrize(("hook", "said"), [("ruff-check", "F401"), ("ruff-format", "1 file reformatted")])
def test_a_file_against_the_style_stops_a_commit(hook: str, said: str, checkout: Path) -> None:
    (checkout / "a.py").write_text('"""A module."""\n')
    assert (well := run(hook, checkout)).returncode == 0, well.stdout
    (checkout / "a.py").write_text("import os\nx =  1\n")
    stopped = run(hook, checkout)
    assert stopped.returncode == 1
    assert said in stopped.stdout
