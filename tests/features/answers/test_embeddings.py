"""Passages found by meaning: vectors from a server, with a threshold that the exhibition's own questions set."""

import json
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import pytest

from lumen.features.answers import server_vectors as embedded
from lumen.features.answers.module import Answers
from lumen.language.knowledge import Passage, QuestionSet
from lumen.language.modules import ANSWERS, ModuleSettings
from lumen.language.projects import Project
from tests.features.answers.conftest import Desk
from tests.features.answers.fake_model import FakeModel, Handler, fake_model

MEANINGS = ("height tall big size", "song sing music tune", "exit door leave way out")
"""The three meanings of the fake model, each with its words."""
PASSAGES = {
    "height": Passage("height", {"en": ("how tall are you",)}, {"en": "I am small."}),
    "songs": Passage("songs", {"en": ("can you sing",)}, {"en": "I know one."}),
}
OWN = {
    "visitors": QuestionSet(
        "visitors",
        {
            "height": {"en": ("what size are you", "how big a size is he")},
            "songs": {"en": ("play some music or a tune",)},
        },
        {"en": ("where is the exit", "which door is the way out")},
    )
}


def vector(text: str) -> list[float]:
    return [0.3 + sum(word in meaning.split() for word in text.split()) for meaning in MEANINGS]


def meaning(handler: Handler, body: dict[str, Any]) -> None:
    """Reply with the vectors in reverse order: their index identifies them."""
    handler.begin("application/json")
    rows = [{"index": i, "embedding": vector(text)} for i, text in enumerate(body["input"])]
    handler.wfile.write(json.dumps({"data": rows[::-1]}).encode())


def with_embeddings(project: Project, url: str, **more: Any) -> Project:
    options = {"embeddings": {"url": url, "name": "small", "key": "FAKE_KEY"}, **more}
    modules = {**project.modules, ANSWERS: ModuleSettings(False, options)}
    return replace(project, knowledge=PASSAGES, questions=OWN, modules=modules)


@pytest.fixture
def asking(project: Project, monkeypatch: pytest.MonkeyPatch) -> Any:
    """Return a function that makes a desk whose embeddings come from a server with that reply."""
    monkeypatch.setenv("FAKE_KEY", "sk-secret")
    opened: list[Any] = []

    def make(reply: Callable[[Handler, dict[str, Any]], None], **more: Any) -> Desk:
        server = fake_model(reply)
        model: FakeModel = server.__enter__()
        desk = Desk(with_embeddings(project, model.url, **more), model)
        opened.append((desk, server))
        return desk

    yield make
    for desk, server in opened:
        desk.module.close()
        server.__exit__(None, None, None)


def test_other_words_of_the_same_meaning_find_the_passage(asking: Any) -> None:
    desk = asking(meaning)
    (said,) = desk.ask("sing me a tune")
    assert {key: said[key] for key in ("text", "source", "passage", "language")} == {
        "text": "I know one.",
        "source": "passage",
        "passage": "songs",
        "language": "en",
    }
    assert desk.ask("show me the way out") == []
    assert not desk.told


def test_what_is_known_is_asked_for_once_and_in_batches(asking: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(embedded, "BATCH", 4)
    desk = asking(meaning)
    desk.ask("how big")
    first = [body["input"] for _, body in desk.model.requests]
    assert sum(map(len, first)) == 1 + 2 + 5 + 2
    assert max(map(len, first)) == 4
    desk.ask("what size")
    assert [body["input"] for _, body in desk.model.requests][len(first) :] == [["what size"]]
    headers, body = desk.model.requests[0]
    assert (headers["Authorization"], body["model"]) == ("Bearer sk-secret", "small")


def _no_list(handler: Handler, body: dict[str, Any]) -> None:
    handler.begin("application/json")
    handler.wfile.write(b'{"data": 3}')


def _zeros(handler: Handler, body: dict[str, Any]) -> None:
    handler.begin("application/json")
    rows = [{"index": i, "embedding": [0.0, 0.0]} for i in range(len(body["input"]))]
    handler.wfile.write(json.dumps({"data": rows}).encode())


def _uneven(handler: Handler, body: dict[str, Any]) -> None:
    handler.begin("application/json")
    rows = [{"index": i, "embedding": [1.0] * (i + 1)} for i in range(len(body["input"]))]
    handler.wfile.write(json.dumps({"data": rows}).encode())


def _huge(handler: Handler, body: dict[str, Any]) -> None:
    handler.begin("application/json")
    handler.wfile.write(b" " * (embedded.MAX_BYTES + 1))


def _refuses(handler: Handler, body: dict[str, Any]) -> None:
    handler.begin(status=429)


FAULTS = {
    _no_list: "is not a list of embeddings",
    _zeros: "is not a list of embeddings",
    _uneven: "different",
    _huge: "more than",
    _refuses: "429",
}


@pytest.mark.parametrize("fault", FAULTS, ids=lambda fault: fault.__name__)
def test_a_server_that_fails_costs_the_answer(asking: Any, fault: Any) -> None:
    desk = asking(fault)
    assert desk.ask("how big") == []
    assert FAULTS[fault] in desk.told[0]
    assert "sk-secret" not in desk.told[0]


def test_a_model_is_asked_what_no_passage_means_and_given_the_nearest(asking: Any) -> None:
    def both(handler: Handler, body: dict[str, Any]) -> None:
        if "input" in body:
            meaning(handler, body)
            return
        handler.begin()
        handler.delta(content="It is that way. ")
        handler.done()

    desk = asking(both)
    url = desk.model.url
    desk.module.use(with_embeddings(desk.project, url, model={"url": url, "name": "fake"}))
    assert desk.said("is the exit as big as a song") == ["It is that way."]
    _, body = desk.model.requests[-1]
    assert json.loads(body["messages"][-1]["content"])["passages"] == ["I know one.", "I am small."]


def test_without_questions_of_its_own_nothing_is_answered(project: Project, asking: Any) -> None:
    desk = asking(meaning)
    desk.module.use(replace(with_embeddings(desk.project, desk.model.url), questions={}))
    assert desk.ask("sing me a tune") == []
    assert not desk.told


def test_it_is_refused_where_neither_is_configured(project: Project) -> None:
    bare = replace(project, modules={**project.modules, ANSWERS: ModuleSettings(False, {})})
    with pytest.raises(Exception, match="no language model is configured"):
        Answers(bare, Desk.__new__(Desk), print)  # type: ignore[arg-type]
