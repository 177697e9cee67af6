"""examples/bodies: models of packages, described in YAML alone, greet whoever comes."""

from pathlib import Path

import pytest

from lumen.cli.main import main
from tests import ROOT
from tests.copying import copied_project
from tests.scanning import matching

EXAMPLES = ROOT / "examples/bodies"
BODIES = sorted(folder.name for folder in EXAMPLES.iterdir() if folder.is_dir())


def test_there_are_two_and_neither_brings_a_model_along() -> None:
    assert BODIES == ["jaco", "rat"]
    assert not [file for file in matching(EXAMPLES, "**/*") if file.suffix in (".xml", ".stl", ".obj", ".msh")]


@pytest.mark.parametrize("name", BODIES)
def test_nothing_is_wrong_with_it(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["lint", str(EXAMPLES / name)]) == 0
    assert "nothing wrong" in "".join(capsys.readouterr())


@pytest.mark.physics
@pytest.mark.parametrize("name", BODIES)
def test_its_story_goes_well_at_honest_physics(name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = copied_project(EXAMPLES / name, tmp_path / name)
    assert main(["run", str(folder), "--story", "visitor", "--speed", "max"]) == 0
    assert "All well" in capsys.readouterr().out
