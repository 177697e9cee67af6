"""The shipped tour performed by other bodies: the same files, without errors, from the first word to the last."""

from pathlib import Path

import pytest

import lumen
from lumen.cli.main import main
from lumen.language.diagnostics import has_errors
from lumen.project.chosen_model import MODEL_VARIABLE
from lumen.run.rehearsal import rehearse
from tests import ROOT


@pytest.mark.parametrize("model", ["greeter", "lantern", "sprout"])
def test_the_visitor_is_guided_by_any_robot(model: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(MODEL_VARIABLE, model)
    found = lumen.check(ROOT)
    assert not has_errors(found)
    assert {d.code for d in found} == {"left-out"}
    project = lumen.load(ROOT)
    rehearsal = rehearse(project, project.stories["visitor"])
    assert not rehearsal.failed


def test_pepper_is_guided_through_by_the_recording_robot(monkeypatch: pytest.MonkeyPatch) -> None:
    """Without a model Pepper has no errors; its shoulders do not turn inwards, as two gestures would."""
    monkeypatch.setenv(MODEL_VARIABLE, "pepper")
    found = lumen.check(ROOT)
    assert not has_errors(found)
    assert {d.code for d in found} == {"left-out", "out-of-reach"}
    assert {d.place.file for d in found if d.code == "out-of-reach"} == {"motions/gestures/guide.yaml"}
    project = lumen.load(ROOT)
    assert project.body.mjcf == ""
    rehearsal = rehearse(project, project.stories["visitor"])
    assert not rehearsal.failed


@pytest.mark.process
def test_a_body_without_a_model_is_not_simulated(
    copy: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv(MODEL_VARIABLE, "pepper")
    assert main(["run", "--robot", "simulation", str(copy), "--for", "1s"]) == 2
    assert "Pepper has no MJCF: run it with --robot naoqi or --robot recording" in capsys.readouterr().err
