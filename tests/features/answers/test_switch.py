"""The switch of the language model: it acts at once, and outlasts restarts until an operator switches back."""

from pathlib import Path
from typing import Any

import pytest

from lumen.bus import connect
from lumen.language.projects import Project
from lumen.run.decisions import SILENCED_FILE, UNREADABLE, ModelSwitch
from lumen.run.questions import Questions
from tests.features.answers.conftest import with_model


def switch(project: Project, folder: Path, kept: list[Any]) -> tuple[ModelSwitch, Questions]:
    questions = Questions(connect("memory://", project))
    return ModelSwitch(questions, lambda: project, kept.append, folder), questions


def test_it_outlasts_a_restart(project: Project, tmp_path: Path) -> None:
    ready, kept = with_model(project, "http://127.0.0.1:9/"), list[Any]()
    first, questions = switch(ready, tmp_path, kept)
    assert (first.state, questions.silenced) == ("on", "")
    assert first.switch("ada", on=False) == {"verdict": "done", "model": "off"}
    second, questions = switch(ready, tmp_path, kept)
    assert (second.state, questions.silenced) == ("off", "ada")
    assert second.switch("ada", on=True) == {"verdict": "done", "model": "on"}
    assert switch(ready, tmp_path, kept)[0].state == "on"
    assert kept == [{"model": "off", "by": "ada"}, {"model": "on", "by": "ada"}]


@pytest.mark.parametrize("text", ["", "[]", "{", "{}", '{"by": 5}'])
def test_what_can_not_be_read_is_no_reason_to_speak(project: Project, tmp_path: Path, text: str) -> None:
    (tmp_path / SILENCED_FILE).write_text(text)
    made, questions = switch(with_model(project, "http://127.0.0.1:9/"), tmp_path, [])
    assert made.state == "off"
    assert questions.silenced == ("5" if "5" in text else UNREADABLE)


def test_where_it_can_not_be_kept_that_is_said(project: Project, tmp_path: Path) -> None:
    (tmp_path / SILENCED_FILE).mkdir()
    made, _ = switch(with_model(project, "http://127.0.0.1:9/"), tmp_path, [])
    assert "until the next start only" in made.switch("ada", on=False)["text"]


def test_without_a_model_there_is_nothing_to_switch(project: Project, tmp_path: Path) -> None:
    made, _ = switch(project, tmp_path, [])
    assert (made.state, made.switch("ada", on=False)["verdict"]) == (None, "refused")
