"""The package that teaches robots to blink, installed into a folder of its own for the tests of this folder."""

from collections.abc import Iterator
from pathlib import Path

import pytest
from written_distribution import on_path, write_distribution

from tests import ROOT
from tests.copying import copied_project
from tests.scanning import matching
from tests.waiting import finished, threads

HERE = ROOT / "tests/stranger_verbs"


@pytest.fixture(autouse=True)
def blinker(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    source = HERE / "distribution"
    files = {path.relative_to(source).as_posix(): path.read_text("utf-8") for path in matching(source, "**/*.py")}
    write_distribution(tmp_path / "packages", "lumen-blinker", "lumen_blinker:FEATURE", files)
    monkeypatch.setenv("PYTHONPATH", str(tmp_path / "packages"))  # for processes that a test starts
    with on_path(tmp_path / "packages"):
        yield
        for thread in threads("lumen-skill-"):
            finished(thread)  # one that imports its performer later would leave it to the next test


@pytest.fixture
def project(tmp_path: Path) -> Path:
    """A project whose robot blinks."""
    return copied_project(HERE / "project", tmp_path / "project")
