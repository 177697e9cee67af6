"""The stranger's distribution, built and installed into a folder of its own, for processes and for this one."""

import shutil
import sys
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from subprocess import CompletedProcess

import pytest
from written_distribution import on_path, write_distribution

from tests import ROOT
from tests.guarded import run_guarded
from tests.waiting import HANG

SOURCES = Path(__file__).parent / "distribution"

Lumen = Callable[..., "CompletedProcess[str]"]


class Installed:
    """A folder of distributions that this process uses; `write` installs or replaces one."""

    def __init__(self, folder: Path, contexts: ExitStack) -> None:
        self.folder, self._contexts = folder, contexts

    def write(self, name: str, manifest: str, version: str = "1.0", **modules: str) -> None:
        """Install a distribution whose module of its name is the manifest, and use it from now on."""
        module = name.replace("-", "_")
        files = {f"{name}.py": text for name, text in {module: manifest, **modules}.items()}
        shutil.rmtree(self.folder / "__pycache__", ignore_errors=True)  # Python sees no change within a second
        write_distribution(self.folder, name, f"{module}:FEATURE", files, version)
        self._contexts.close()
        self._contexts.enter_context(on_path(self.folder))


@pytest.fixture
def installed(tmp_path: Path) -> Iterator[Installed]:
    """Distributions that a test writes."""
    with ExitStack() as contexts:
        yield Installed(tmp_path / "packages", contexts)


@pytest.fixture(scope="session")
def stranger_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder into which `lumen-stranger` is installed, outside the engine's tree."""
    return install(SOURCES, tmp_path_factory.mktemp("stranger"))


@pytest.fixture
def stranger(stranger_folder: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """`lumen-stranger`, found by this process and by those that it starts; the folder that it is in."""
    with used(stranger_folder, monkeypatch):
        yield stranger_folder


@pytest.fixture
def stranger_lumen(stranger: Path) -> Lumen:
    """`lumen` in a process of its own beside the stranger's distribution: `stranger_lumen(folder, "lint")`."""
    return call_lumen


def install(sources: Path, folder: Path) -> Path:
    """Build the distribution of these sources, install it into a folder, and return the folder."""
    options = "--quiet", "--no-deps", "--no-index", "--no-build-isolation", "--disable-pip-version-check"
    run_guarded(
        [sys.executable, "-m", "pip", "install", *options, "--target", folder, sources],
        check=True,
        timeout=HANG,
        capture_output=True,
        text=True,
    )
    return folder


@contextmanager
def used(folder: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Let this process, and those that it starts, find the distributions in a folder."""
    monkeypatch.setenv("PYTHONPATH", f"{folder}:{ROOT / 'engine'}")
    with on_path(folder):
        yield


def call_lumen(folder: Path, *words: str) -> "CompletedProcess[str]":
    """Run `lumen` in a process of its own, in a folder."""
    command = [sys.executable, "-m", "lumen", *words]
    return run_guarded(command, cwd=folder, timeout=HANG, capture_output=True, text=True)
