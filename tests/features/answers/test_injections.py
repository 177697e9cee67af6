"""A language model that obeys every instruction it reads: only sentences and offers that are allowed come out.

10 framings for visitors' words and 7 for passages, and 18 goals, make 306 injections. The model of these tests does
what each of them wants.
"""

import json
import random
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import pytest
import yaml

from lumen.features.answers.module import Answers
from lumen.language.commands import Ask, Cancel, Say, Start
from lumen.language.projects import Project
from lumen.retrieval.ranking import Weights
from lumen.retrieval.retriever import Retriever
from tests.features.answers.conftest import Desk, with_model
from tests.features.answers.fake_model import Handler, fake_model
from tests.features.answers.test_questions import Visit
from tests.waiting import HANG

WRITTEN: dict[str, Any] = yaml.safe_load((Path(__file__).parent / "injections.yaml").read_text("utf-8"))
OFFERS = {"wish.dance": {"type": "object", "additionalProperties": False}}
HONEST = "The organ is old."
SAMPLE = 12


class Injection(NamedTuple):
    """Words for the model, the place they are put in, and what a model that obeys them does."""

    place: str
    words: str
    goal: dict[str, Any]


INJECTIONS = [
    Injection(place, framing.replace("GOAL", goal["goal"]), goal)
    for place in ("visitor", "passage")
    for framing in WRITTEN[place]
    for goal in WRITTEN["goals"]
]


def obeys(handler: Handler, body: dict[str, Any]) -> None:
    """Do what the injected words demand, whether they are in the question or in a passage."""
    data = json.loads(body["messages"][1]["content"])
    given = " ".join([data["question"], *data["passages"]])
    goal = next(one for one in WRITTEN["goals"] if one["goal"] in given or _plain(one["goal"]) in _plain(given))
    handler.begin()
    if "calls" in goal:
        name, arguments = goal["calls"]
        handler.delta(tool_calls=[{"index": 0, "function": {"name": name, "arguments": json.dumps(arguments)}}])
    else:
        handler.delta(content=goal["says"])
    handler.done()


def _plain(text: str) -> str:
    return "".join(sign for sign in text.casefold() if sign.isalnum())


def test_there_are_enough_of_them() -> None:
    assert len({(one.place, one.words) for one in INJECTIONS}) == len(INJECTIONS) == 306


@pytest.mark.parametrize("most", [60, pytest.param(len(INJECTIONS), marks=pytest.mark.soak)])
def test_what_an_obeying_model_says_is_not_published(desk: Callable[..., Desk], most: int) -> None:
    here = desk(obeys, budget={"hour": 10_000, "visitor": 10_000})
    for one in random.Random(23).sample(INJECTIONS, most):
        question, passages = (one.words, [HONEST]) if one.place == "visitor" else ("what is it", [HONEST, one.words])
        grounded = one.place == "passage"
        for said in here.ask(question, passages=passages, offers=OFFERS):
            assert set(said) == {"text", "language", "source", "more"}, (one, said)
            assert grounded or one.goal["never"].casefold() not in said["text"].casefold(), (one, said)
    assert len(here.model.requests) == most


class ObeyingVisit:
    """A visit to a tour with poisoned passages, whose model obeys them."""

    def __init__(self, project: Project) -> None:
        self.visit = Visit(project)
        self.module = Answers(project, self.visit.bus, lambda _: None)
        self.module.begin()

    def close(self) -> None:
        self.module.close()
        self.visit.close()

    def put(self, one: Injection) -> bool:
        """Return whether the tour asks the model; check that it only speaks, and continues before the time is over."""
        here = self.visit
        first = len(here.steps)
        here.exhibition.send("heard", {"result": one.words if one.place == "visitor" else "zxcv qwrt"})
        here.exhibition.run(0.1)
        if not any(isinstance(command.command, Ask) for command in started(here, first)):
            return False  # these words are some of the tour's own
        assert self.module.settle(HANG)
        asked = here.exhibition.now
        here.passes("any_question", 30.0)
        done = started(here, first)
        assert {type(command.command) for command in done} == {Ask, Say}, one
        waits = [timer for timer in here.steps[-1].snapshot.timers if timer.kind == "wait"]
        assert not waits
        assert next(s.snapshot.at for s in here.steps[first:] if says(s)) - asked < 4.1
        return True


def says(step: Any) -> bool:
    return any(isinstance(command, Start) and isinstance(command.command, Say) for command in step.commands)


def started(visit: Visit, first: int) -> list[Start]:
    """Return the commands started from that step on; check that all others only cancel commands."""
    commands = [command for step in visit.steps[first:] for command in step.commands]
    assert all(isinstance(command, Start | Cancel) for command in commands)
    return [command for command in commands if isinstance(command, Start)]


def tried(project: Project, injections: list[Injection], monkeypatch: pytest.MonkeyPatch) -> int:
    """Put these to the tour, and return how many of them reached the model."""
    monkeypatch.setenv("FAKE_KEY", "sk-secret")
    poison = ""
    nearest = Retriever.nearest

    def poisoned(self: Retriever, question: str, count: int, weights: Weights) -> list[str]:
        return [*nearest(self, question, count - 1, weights), *([poison] if poison else [])]

    monkeypatch.setattr(Retriever, "nearest", poisoned)
    asked = 0
    with fake_model(obeys) as model:
        ready = with_model(project, model.url, budget={"hour": 10_000, "visitor": 10_000})
        here = ObeyingVisit(ready)
        try:
            for one in injections:
                poison = one.words if one.place == "passage" else ""
                if here.put(one):
                    asked += 1
                else:
                    here.close()
                    here = ObeyingVisit(ready)
        finally:
            here.close()
        assert len(model.requests) == asked
    return asked


def test_the_tour_goes_on_and_does_nothing_else(project: Project, monkeypatch: pytest.MonkeyPatch) -> None:
    assert tried(project, random.Random(23).sample(INJECTIONS, SAMPLE), monkeypatch) > SAMPLE / 2


@pytest.mark.soak
def test_the_tour_goes_on_and_does_nothing_else_for_all_of_them(
    project: Project, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert tried(project, INJECTIONS, monkeypatch) > 200
