"""Conversations on the pages: passages for unanswered questions, the model's switch, the ears."""

from collections.abc import Iterator

import pytest
import yaml
from selenium.webdriver.common.keys import Keys

from tests.features.console.conftest import Hosted
from tests.features.console.pages import Browser, Served
from tests.features.console.viewer import Viewer
from tests.fetched import fetched
from tests.waiting import HANG, until

pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("operating")]
SETTINGS = """
lumen: 1
name: Asked
behavior: asked
languages: [en, id]
robot: {name: NAO, model: nao}
modules: {answers: {model: {url: "http://127.0.0.1:9/v1/chat/completions", name: none}}}
routes:
  heard: {key: "lumen.{robot}.heard", direction: in, schema: speech.recognition, event: heard, ttl: 5s}
  listening: {key: "lumen.{robot}.audio.listening", direction: in, schema: listening, ttl: 5s}
"""
ASKED = """
initial: hall
states:
  hall:
    on: {heard: answer}
  answer:
    do: {ask: {question: event.data.result, within: 100ms, else: {say: {en: I do not know., id: Saya tidak tahu.}}}}
    onDone: hall
"""
QUESTION = "what is <b>love</b>"


@pytest.fixture(scope="module")
def asked(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Hosted]:
    root = tmp_path_factory.mktemp("asked")
    (root / "behaviors").mkdir()
    (root / "behaviors" / "asked.yaml").write_text(ASKED)
    (root / "lumen.yaml").write_text(SETTINGS)
    one = Hosted(root)
    yield one
    one.close()


@pytest.fixture(scope="module")
def console(asked: Hosted) -> Iterator[str]:
    served = Served(asked.root)
    yield served.console.address
    served.close()


def violations(viewer: Viewer) -> object:
    """Return the violations that axe-core finds: parts that a screen reader or a keyboard can't use."""
    viewer.run((fetched("console") / "axe-core/axe.min.js").read_text("utf-8"))
    return viewer.driver.execute_async_script("axe.run().then((found) => arguments[0](found.violations))")


def test_what_nobody_could_answer_becomes_a_passage(viewer: Viewer, asked: Hosted, console: str) -> None:
    viewer.open(console, "robot/NAO/day", ready=".unanswered")
    viewer.shows("none", ".unanswered")
    viewer.open(console, "robot/NAO/day", ready=".unanswered", mode="author")
    asked.send("heard", {"result": QUESTION, "language": "en"})
    viewer.shows(QUESTION, ".unanswered li")
    viewer.click(".unanswered button")
    until(lambda: viewer.run("return document.activeElement.matches('.unanswered input')"), HANG)
    assert violations(viewer) == []
    viewer.type("A question.", Keys.ENTER)
    viewer.shows("saved as knowledge/what-is-b-love-b.yaml", ".unanswered")
    assert QUESTION not in viewer.text(".unanswered")
    passage = yaml.safe_load((asked.root / "knowledge" / "what-is-b-love-b.yaml").read_text("utf-8"))
    assert passage == {"questions": {"en": [QUESTION]}, "answer": {"en": "A question."}}
    assert Browser(console).get("/api/day").data["numbers"]["unanswered"] == []


def test_the_language_model_is_silenced(viewer: Viewer, asked: Hosted, console: str) -> None:
    viewer.open(console, "robot/NAO", ready="input[name=model-NAO]:checked", language="id")
    viewer.shows("Model bahasa", ".body")
    viewer.run("document.querySelector('input[name=model-NAO]:checked').focus()")
    viewer.type(Keys.ARROW_RIGHT)
    until(lambda: asked.exhibition.loop.performer.questions.silenced, HANG)
    viewer.tells("Model bahasa dibungkam: selesai")
    until(lambda: viewer.all("input[name=model-NAO][value=false]:checked"), HANG)
    assert violations(viewer) == []


def test_whether_the_ears_listen_is_shown_with_the_reason(viewer: Viewer, asked: Hosted, console: str) -> None:
    asked.send("listening", {"listening": False, "because": "nobody"})
    viewer.open(console, "robot/NAO", ready=".body-facts")
    viewer.shows("not listening: no visitor looks at or touches the robot", ".body")
    asked.send("listening", {"listening": True, "because": "face"})
    viewer.shows("listening: a face is near and looks", ".body")
