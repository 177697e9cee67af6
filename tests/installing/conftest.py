"""A wheel of this checkout, and an environment that holds its core and nothing more."""

import os
from collections.abc import Callable
from pathlib import Path
from subprocess import CompletedProcess

import installed_size as installing
import pytest

from tests.guarded import run_guarded
from tests.waiting import HANG

Lumen = Callable[..., "CompletedProcess[str]"]


@pytest.fixture(scope="session")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return installing.build(tmp_path_factory.mktemp("wheel"))


@pytest.fixture(scope="session")
def core(wheel: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The Python of an environment with Lumen's core and nothing more."""
    python = installing.environment(tmp_path_factory.mktemp("environment") / "core")
    installing.install(python, "--no-compile", str(wheel))
    return python


@pytest.fixture(scope="session")
def lumen(core: Path) -> Lumen:
    """A function that calls `lumen` of that environment in a folder: `lumen(folder, "lint", "--strict")`."""
    clean = {name: value for name, value in os.environ.items() if not name.startswith("PYTHON")}

    def call(folder: Path, *words: str) -> "CompletedProcess[str]":
        return run_guarded(
            [core.parent / "lumen", *words], cwd=folder, env=clean, timeout=HANG, capture_output=True, text=True
        )

    return call


@pytest.fixture(scope="session")
def exhibition(lumen: Lumen, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A project made by `lumen new`."""
    folder = tmp_path_factory.mktemp("exhibition")
    done = lumen(folder, "new", "mine")
    assert done.returncode == 0, done.stderr
    return folder / "mine"
