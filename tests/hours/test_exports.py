"""Times of day in files of other tools: listed if they are left out, and drawn."""

from pathlib import Path

import pytest

from lumen.cli.main import main
from tests.tour.conftest import copy

__all__ = ["copy"]

HALL = 'states:\n  open: {at: {"mon-fri 18:00": closed}}\n  closed: {at: {"09:00": open}}\n'


@pytest.mark.parametrize("format", ["scxml", "xstate"])
def test_what_is_left_out_is_listed(
    copy: Path, format: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    (copy / "behaviors" / "hall.yaml").write_text(HALL, "utf-8")
    monkeypatch.chdir(copy)
    assert main(["export", format, "hall"]) == 1
    out, told = capsys.readouterr()
    assert "18:00" not in out
    assert "behaviors/hall.yaml:2:32 error[not-carried-over] `at: mon-fri 18:00` is left out" in told
    assert told.count("not-carried-over] `at:") == 2


@pytest.mark.parametrize(("format", "shown"), [("mermaid", "at mon-fri 18#58;00"), ("dot", "at mon-fri 18:00")])
def test_a_diagram_shows_it(
    copy: Path, format: str, shown: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    (copy / "behaviors" / "hall.yaml").write_text(HALL, "utf-8")
    monkeypatch.chdir(copy)
    assert main(["export", format, "hall"]) == 0
    assert shown in capsys.readouterr().out
