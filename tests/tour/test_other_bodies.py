"""The shipped tour performed by other bodies: the same files, without errors, from the first word to the last."""

from pathlib import Path

import pytest

import lumen
from lumen.app.rehearsal import rehearse
from lumen.language.diagnostics import has_errors
from lumen.loading.chosen_model import MODEL_VARIABLE

ROOT = Path(__file__).parents[2]


@pytest.mark.parametrize("model", ["greeter", "lantern", "sprout"])
def test_the_visitor_is_guided_by_any_robot(model: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(MODEL_VARIABLE, model)
    found = lumen.check(ROOT)
    assert not has_errors(found)
    assert {d.code for d in found} == {"left-out"}
    project = lumen.load(ROOT)
    rehearsal = rehearse(project, project.stories["visitor"])
    assert not rehearsal.failed
