"""Questions of a tour before a language model that may be missing, slow, silenced, or obey whoever asks it."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from lumen.bus import connect
from lumen.features.answers.module import Answers
from lumen.language.command_data import command_data
from lumen.language.commands import Ask, Say, Start
from lumen.language.projects import Project
from lumen.language.stories import Visitor
from lumen.run.exhibition import Exhibition
from lumen.run.plan import Plan
from lumen.run.setup import set_up
from lumen.statechart import Step
from tests.features.answers.conftest import with_model
from tests.waiting import until

FILLER = {"after": 1.5, "say": {"en": "Let me think."}}


class Visit:
    """The tour on a recording robot in virtual time, after a visitor has reached the state `offer`."""

    def __init__(self, project: Project) -> None:
        self.bus = connect("memory://", project)
        self.steps: list[Step] = []
        self.exhibition = Exhibition(Plan(project, set_up("recording", project, "max"), self.bus))
        self.exhibition.observe(self.steps.append)
        self.exhibition.start()
        self.exhibition.run(1.0)
        self.questions = self.exhibition.loop.performer.questions
        self.asks: list[Any] = []
        self.bus.subscribe("lumen.NAO.ask", lambda message: self.asks.append(message.body))
        visitor = self.exhibition.visitor
        assert visitor
        visitor.arrive(Visitor())
        self.passes("ask_name")
        self.says("My name is Budi", "how_are_you")
        self.says("fine", "offer")

    def passes(self, state: str, most: float = 40.0) -> None:
        """Let time pass until the tour is in that state, at most `most` [s]."""
        end = self.exhibition.now + most
        while state not in self.exhibition.configuration:
            assert self.exhibition.now < end, self.exhibition.configuration
            self.exhibition.tick()

    def says(self, text: str, state: str) -> None:
        self.exhibition.send("heard", {"result": text})
        self.exhibition.run(0.1)
        self.passes(state)

    def answers(self, **said: Any) -> None:
        self.bus.publish("lumen.NAO.answer", {"id": self.asks[-1]["id"], **said})
        self.exhibition.run(0.1)

    @property
    def said(self) -> list[str]:
        started = [c for one in self.steps for c in one.commands if isinstance(c, Start)]
        asked = [i for i, c in enumerate(started) if isinstance(c.command, Ask)]
        return [c.command.text for c in started[asked[-1] if asked else 0 :] if isinstance(c.command, Say)]

    def close(self) -> None:
        self.exhibition.close()


@pytest.fixture
def visit(project: Project, request: pytest.FixtureRequest) -> Callable[..., Visit]:
    def make(**options: Any) -> Visit:
        made = Visit(with_model(project, "http://127.0.0.1:9/", **options))
        request.addfinalizer(made.close)
        return made

    return make


QUESTION = "does Budi think that robots dream"


@pytest.mark.once
def test_a_model_is_asked_without_names_and_what_it_says_is_said(visit: Callable[..., Visit]) -> None:
    here = visit()
    here.says(QUESTION, "answer")
    [asked] = here.asks
    assert asked["question"] == "does think that robots dream"
    assert "Budi" not in str(asked)
    assert (asked["language"], asked["within"], asked["robot"], asked["visit"]) == ("en", 4.0, "NAO", 1)
    assert set(asked["offers"]) == {"wish.dance", "wish.sing", "wish.photo"}
    assert len(asked["passages"]) == 3
    here.answers(text="I do not dream.", language="en", more=True)
    here.answers()
    here.passes("any_question")
    assert here.said[:1] == ["I do not dream."]


def test_who_does_not_answer_in_time_is_not_waited_for(visit: Callable[..., Visit]) -> None:
    here = visit(filler=FILLER)
    here.says(QUESTION, "answer")
    began = here.exhibition.now
    here.passes("any_question")
    assert here.said[0] == "Let me think."
    assert "desk" in here.said[1]
    here.answers(text="Too late.")
    assert "Too late." not in here.said
    ended = next(one for one in here.steps if one.event and one.event.name.startswith("wait.w") and one.commands)
    assert ended.snapshot.at - began < 4.1


def test_an_event_is_raised_only_where_it_is_offered(visit: Callable[..., Visit]) -> None:
    here = visit()
    here.says(QUESTION, "answer")
    here.answers(**{"raise": {"event": "wish.dance", "data": {}}})
    here.passes("dance", 1.0)


@pytest.mark.parametrize(
    "raised",
    [
        {"event": "operator.end", "data": {}},
        {"event": "safety.alarm", "data": {}},
        {"event": "stop", "data": {}},
        {"event": "wish.dance", "data": {"motion": "goodbye"}},
        {"event": "wish.dance"},
        "wish.dance",
        {"event": "done.command.d1", "data": {}},
    ],
)
def test_nothing_else_is_raised(visit: Callable[..., Visit], raised: Any) -> None:
    here = visit()
    here.says(QUESTION, "answer")
    here.answers(**{"raise": raised})
    assert "answer" in here.exhibition.configuration
    assert "desk" in here.said[0]


def test_who_is_silenced_says_nothing_more(visit: Callable[..., Visit]) -> None:
    here = visit()
    here.says(QUESTION, "answer")
    here.questions.silence("ada")
    here.answers(text="I do dream.")
    here.passes("any_question")
    assert "desk" in here.said[0]
    here.says(QUESTION, "answer")
    assert len(here.asks) == 1
    here.passes("any_question")
    here.questions.silence("")
    here.says(QUESTION, "answer")
    assert len(here.asks) == 2


def test_another_visitor_is_counted(visit: Callable[..., Visit]) -> None:
    here = visit()
    here.says(QUESTION, "answer")
    here.passes("goodbye", 100.0)
    here.passes("greet")  # at once, since a visitor is present: idle may end within a tick
    assert here.questions.visit == 2


def test_steps_are_taken_again_without_the_model(visit: Callable[..., Visit]) -> None:
    from lumen.statechart import step

    here = visit(filler=FILLER)
    here.says(QUESTION, "answer")
    here.answers(text="I do not dream.", more=True)
    here.passes("any_question")
    machine = here.exhibition.project.machine
    for before, taken in zip(here.steps, here.steps[1:], strict=False):
        assert taken.event
        again = step(machine, before.snapshot, taken.event)
        assert (again.snapshot, command_data(again.commands)) == (taken.snapshot, command_data(taken.commands))


def test_a_project_without_the_module_knows_at_once(project: Project, tmp_path: Path) -> None:
    here = Visit(replace(project, modules={}))
    here.says(QUESTION, "answer")
    assert "desk" in here.said[0]
    here.close()


def test_the_network_is_cut_in_the_middle_of_a_visit(visit: Callable[..., Visit]) -> None:
    """No server answers at the address: the module reports it once, and the tour continues."""
    here = visit()
    told: list[str] = []
    module = Answers(here.exhibition.project, here.bus, told.append)
    module.begin()
    try:
        here.says(QUESTION, "answer")
        until(lambda: told)
        here.passes("any_question")
        assert "desk" in here.said[0]
        assert len(told) == 1
    finally:
        module.close()
