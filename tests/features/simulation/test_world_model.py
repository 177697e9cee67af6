"""A cached world equals a newly compiled one to the bit, and is never used for other files."""

import shutil
from collections.abc import Iterator
from pathlib import Path

import mujoco
import numpy as np
import pytest

import lumen
from lumen.features.simulation import model
from lumen.features.simulation.model_terms import Variation
from lumen.features.simulation.world_model import physics
from lumen.project import memoization
from tests import ROOT


@pytest.fixture
def models(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A copy of the shipped models, and an empty cache; the memory of this process is restored at the end."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    monkeypatch.setattr(memoization, "_last", {})
    shutil.copytree(ROOT / "models", tmp_path / "models")
    return tmp_path / "models"


@pytest.fixture
def compiled(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """A list with one entry for each world that is compiled."""
    done, compile_world = [], model.compile_world

    def counting(world: object) -> mujoco.MjModel:
        done.append("compiled")
        return compile_world(world)

    monkeypatch.setattr(model, "compile_world", counting)
    return done


def made(models: Path, variation: Variation | None = None) -> bytes:
    """Return the bytes of the world that a new process would get."""
    memoization._last.clear()
    found = physics(lumen.load(ROOT).body, models, "hall.xml", variation, backlash=True).model.ptr
    content = np.zeros(mujoco.mj_sizeModel(found), np.uint8)
    mujoco.mj_saveModel(found, None, content)
    return content.tobytes()


def test_it_is_compiled_once_and_the_same_to_the_bit(models: Path, compiled: list[str], tmp_path: Path) -> None:
    first = made(models)
    assert made(models) == first
    elsewhere = shutil.copytree(models, tmp_path / "elsewhere/models")
    assert made(elsewhere) == first
    assert len(compiled) == 1


def test_other_files_make_another_world(models: Path, compiled: list[str]) -> None:
    first = made(models)
    robot = models / "nao.xml"
    text = robot.read_text("utf-8")
    assert 'mass="0.' in text
    robot.write_text(text.replace('mass="0.', 'mass="1.', 1), "utf-8")
    assert made(models) != first
    assert made(models, Variation(mass=1.1)) != first
    assert len(compiled) == 3


def test_what_is_broken_on_the_disk_is_made_anew(models: Path, compiled: list[str], tmp_path: Path) -> None:
    first = made(models)
    (kept,) = (tmp_path / "cache/lumen/worlds").iterdir()
    for content in (b"", b"nothing", kept.read_bytes()[:1_000]):
        kept.write_bytes(content)
        assert made(models) == first
    assert len(compiled) == 3 + 1
