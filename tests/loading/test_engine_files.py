"""The fingerprint of the engine: stored results must not outlive the code that made them."""

from importlib import import_module
from pathlib import Path

import pytest

from lumen.features.simulation.trials import outcome_cache
from lumen.project import engine_files

DECIDE = (
    "lumen.motion.gait",
    "lumen.motion.life",
    "lumen.robot.executor",
    "lumen.features.simulation.trials.trial",
    "lumen.project.bodies",
    "lumen.project.roles",
    "lumen.project.units",
)
"""Modules that decide whether a motion falls, at different depths; those of `lumen.project` build the body."""


@pytest.mark.parametrize("name", DECIDE)
def test_outcomes_of_motions_depend_on_code_at_every_depth(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    file, read = Path(str(import_module(name).__file__)), Path.read_bytes
    before = engine_files.code_hash(*outcome_cache.CODE)
    monkeypatch.setattr(Path, "read_bytes", lambda path: read(path) + b"\n" if path == file else read(path))
    assert engine_files.code_hash.__wrapped__(*outcome_cache.CODE) != before


def test_code_that_moved_away_is_not_left_out_silently() -> None:
    with pytest.raises(ModuleNotFoundError, match=r"lumen\.gone"):
        engine_files.code_hash("lumen.motion", "lumen.gone")
