"""An exhibition's own questions set how similar a question must be to a passage, in a run and in `lumen test`."""

import json
from dataclasses import replace
from pathlib import Path

import pytest

import lumen
from lumen.bus import connect
from lumen.cli.main import main
from lumen.language.causes import MessageOrigin
from lumen.language.commands import Ask
from lumen.language.knowledge import Passage, QuestionSet
from lumen.run.questions import Questions
from tests import ROOT
from tests.copying import copied_project

PASSAGES = {
    "height": Passage("height", {"en": ("how tall are you",)}, {"en": "Small."}),
    "songs": Passage("songs", {"en": ("can you sing a song",)}, {"en": "One."}),
}
ASKED = {"height": {"en": ("are you a tall one", "you are tall right")}, "songs": {"en": ("sing me some song",)}}
OWN = {"visitors": QuestionSet("visitors", ASKED, {"en": ("where is the exit",)})}


def test_they_count_while_it_runs() -> None:
    """The question is similar enough for the threshold that they set, but not for the default one."""
    tour, found = lumen.load(ROOT), []
    for questions in ({}, OWN):
        known = replace(tour, knowledge=PASSAGES, questions=questions)
        asked = Ask("how tall is he", within=4.0, language="en")
        events = Questions(connect("memory://")).ask(known, "c1", asked, 0.0, MessageOrigin())
        found.append([event.name for event in events])
    assert found == [["error.command.c1"], ["answer.command.c1"]]


@pytest.fixture
def small(tmp_path: Path) -> Path:
    copied_project(ROOT / "examples/minimal", tmp_path / "show")
    knowledge = tmp_path / "show/knowledge"
    (knowledge / "questions").mkdir(parents=True, exist_ok=True)
    for name, passage in PASSAGES.items():
        (knowledge / f"{name}.yaml").write_text(
            json.dumps({"questions": {"en": passage.questions["en"]}, "answer": dict(passage.answer)}), "utf-8"
        )
    own = {"asked": ASKED, "unanswered": {"en": ["sing out loud how tall the exit is"]}}
    (knowledge / "questions/visitors.yaml").write_text(json.dumps(own), "utf-8")
    return tmp_path / "show"


def test_lumen_test_says_what_comes_of_them(small: Path, capsys: pytest.CaptureFixture[str]) -> None:
    capsys.readouterr()
    assert main(["test", str(small)]) == 0
    assert "4 questions in `en`: " in capsys.readouterr().out
    assert main(["test", str(small), "--format", "json"]) == 0
    (english,) = json.loads(capsys.readouterr().out)["questions"]
    assert (english["language"], english["asked"]) == ("en", 4)
    assert english["rates"]["wrong"] <= 0.02
