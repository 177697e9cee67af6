"""An `after` with a computed time, in files of other tools: listed if it is left out, and drawn."""

from pathlib import Path

import pytest

from lumen.cli.main import main
from tests.tour.conftest import copy

__all__ = ["copy"]

HALL = """
context: {patience: 20}
states:
  open: {after: {"{{ context.patience }}s": closed, 9s: closed}}
  closed: {after: {1h: open}}
"""


@pytest.mark.parametrize("format", ["scxml", "xstate"])
def test_what_is_left_out_is_listed(
    copy: Path, format: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    (copy / "behaviors" / "hall.yaml").write_text(HALL, "utf-8")
    monkeypatch.chdir(copy)
    assert main(["export", format, "hall"]) == 1
    out, told = capsys.readouterr()
    assert "{{" not in out
    assert "9" in out
    assert "error[not-carried-over] `after: {{ context.patience }}s` is left out" in told
    assert told.count("not-carried-over] `after:") == 1


@pytest.mark.parametrize(
    ("format", "shown"),
    [("mermaid", "after #123;#123; context.patience #125;#125;s"), ("dot", "after {{ context.patience }}s")],
)
def test_a_diagram_shows_it(
    copy: Path, format: str, shown: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    (copy / "behaviors" / "hall.yaml").write_text(HALL, "utf-8")
    monkeypatch.chdir(copy)
    assert main(["export", format, "hall"]) == 0
    assert shown in capsys.readouterr().out
