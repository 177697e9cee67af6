"""`answers` in a story: a language model's text, and the effect if it is not offered or not requested."""

from collections.abc import Callable
from pathlib import Path

import pytest

import lumen
from lumen.cli.main import main
from lumen.insight.replay.visits import visits
from lumen.run.replaying.journals import KeptBundles, chosen
from lumen.run.replaying.other_files import with_machines
from lumen.run.storytelling.story_text import story_text
from lumen.run.storytelling.visit_story import visit_story

SETTINGS = """
lumen: 1
name: Asked
behavior: asked
languages: [en]
robot: {name: NAO, model: nao}
modules: {answers: {here: true, model: {url: "http://127.0.0.1:9/v1/chat/completions", name: none}}}
routes:
  heard: {key: "lumen.{robot}.heard", direction: in, schema: speech.recognition, event: heard, ttl: 5s}
"""
ASKED = """
events: {wish.dance: {type: object, properties: {song: {type: string}}}, wish.power: null}
initial: hall
states:
  hall: {on: {heard: answer}}
  answer:
    do: {ask: {question: event.data.result, within: 4s, else: {say: I do not know.}}}
    onDone: hall
    on: {wish.dance: {target: dance, offer: true}, wish.power: dance}
  dance: {}
"""
HEIGHT = "questions: {en: [how tall are you]}\nanswer: {en: I am small.}\n"
Play = Callable[[str], int]


@pytest.fixture
def play(tmp_path: Path) -> Play:
    """A function that plays a story with these steps, and returns the exit code of `lumen test`."""
    (tmp_path / "lumen.yaml").write_text(SETTINGS)
    for folder in ("behaviors/stories", "knowledge"):
        (tmp_path / folder).mkdir(parents=True)
    (tmp_path / "behaviors" / "asked.yaml").write_text(ASKED)
    (tmp_path / "knowledge" / "height.yaml").write_text(HEIGHT)

    def played(steps: str) -> int:
        (tmp_path / "behaviors" / "stories" / "one.yaml").write_text(f"steps:\n{steps}")
        return main(["test", str(tmp_path), "one"])

    return played


@pytest.mark.parametrize(
    "steps",
    [
        "  - answers: I only rest.\n  - expect: {said_exactly: I only rest., state: hall}\n",
        "  - answers: {raise: wish.dance, data: {song: manuk}}\n  - expect: {state: dance}\n",
        "  - answers: {raise: wish.power}\n  - expect: {said: I do not know, within: 2s}\n",
        "  - wait: 3s\n  - answers: I only rest.\n  - expect: {said_exactly: I only rest.}\n",
        "  - expect: {said: I do not know}\n",
    ],
    ids=["text", "offered", "not offered", "late", "nothing"],
)
def test_what_a_model_answers_is_played(play: Play, steps: str) -> None:
    assert play(f"  - says: do you sleep\n{steps}") == 0


def test_each_question_has_an_answer_of_its_own(play: Play) -> None:
    one = "  - says: do you sleep\n  - answers: {}\n  - expect: {{said_exactly: {}, state: hall}}\n"
    assert (
        play("".join(one.replace("{}", text, 2).replace("{{", "{").replace("}}", "}") for text in ("One.", "Two.")))
        == 0
    )


@pytest.mark.parametrize("question", ["", "  - says: how tall are you\n  - expect: {said: small}\n"])
def test_an_answer_to_no_question_fails(play: Play, capsys: pytest.CaptureFixture[str], question: str) -> None:
    assert play(f"{question}  - answers: I only rest.\n") == 1
    told = capsys.readouterr().out
    assert "expected a question to the module `answers` within 30 s, but none was asked" in told


def test_a_question_that_nobody_waits_for_any_more_is_none(play: Play, capsys: pytest.CaptureFixture[str]) -> None:
    steps = "  - says: do you sleep\n  - expect: {said: I do not know}\n  - answers: I only rest.\n"
    assert play(steps) == 1
    assert "none was asked" in capsys.readouterr().out


def test_a_recorded_visit_is_written_with_what_was_answered(play: Play, tmp_path: Path) -> None:
    says = "  - says: do you sleep\n"
    text, raised = "answers: I only rest.", "answers: {raise: wish.dance, data: {song: manuk}}"
    assert (
        play(f"{says}  - {text}\n  - expect: {{state: hall}}\n{says}  - {raised}\n  - expect: {{state: dance}}\n") == 0
    )
    with lumen.open(tmp_path, story="one") as exhibition:
        exhibition.run()
    project = lumen.load(tmp_path)
    found = [*visits(with_machines(chosen(tmp_path, None).entries(), KeptBundles(tmp_path)))]
    made = [visit_story(project, project, visit, name="found", title="Found") for visit in found]
    assert [one.same for one in made] == [True, True]
    for one, wanted in zip(made, (text, raised), strict=True):
        assert wanted in story_text(one.story, [])
