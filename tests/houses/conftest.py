"""A house of two robots with the small example's files."""

import shutil
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
ROBOTS = "robots:\n  ana: {model: nao, at: {y: -0.4}}\n  ben: {model: nao, at: {y: 0.4}}"


@pytest.fixture
def two(tmp_path: Path) -> Path:
    folder = tmp_path / "two"
    shutil.copytree(ROOT / "examples/minimal", folder, ignore=shutil.ignore_patterns(".lumen"))
    main = folder / "lumen.yaml"
    text = main.read_text("utf-8")
    assert "robot: {name: NAO, model: nao}" in text
    main.write_text(text.replace("robot: {name: NAO, model: nao}", ROBOTS), "utf-8")
    return folder
