"""The module `answers` on a bus, connected to a model that answers as the test defines."""

from collections.abc import Callable, Iterator
from contextlib import ExitStack
from dataclasses import replace
from typing import Any

import pytest

import lumen
from lumen.bus import connect
from lumen.features.answers.module import Answers
from lumen.language.modules import ANSWERS, ModuleSettings
from lumen.language.projects import Project
from tests.features.answers.fake_model import FakeModel, Reply, fake_model
from tests.waiting import HANG, Collector, until


@pytest.fixture(scope="session")
def project() -> Project:
    return lumen.load(".")


def with_model(project: Project, url: str, **options: Any) -> Project:
    """Return the project with a language model at that address."""
    options = {"model": {"url": url, "name": "fake", "key": "FAKE_KEY"}, **options}
    return replace(project, modules={**project.modules, ANSWERS: ModuleSettings(False, options)})


LONGEST = 60.0
"""The longest time that the module lets a question wait for its answer [s]."""


class Desk:
    """A client that asks the module; `told` are lines for the operator."""

    def __init__(self, project: Project, model: FakeModel | None = None) -> None:
        self.project, self.model = project, model
        self.told: list[str] = []
        self.bus = connect("memory://", project)
        self.answers = Collector()
        self.bus.subscribe("lumen.NAO.answer", self.answers)
        self.module = Answers(project, self.bus, self.told.append)
        self.module.begin()
        self.asked = 0

    def ask(
        self, question: str = "what is it", language: str = "en", within: float = LONGEST, **more: Any
    ) -> list[Any]:
        """Ask a question, and return the bodies that are published for it, without ids and without the end marker."""
        self.asked += 1
        id = f"d{self.asked}"
        body = {"id": id, "question": question, "language": language, "within": within, "visit": 1, "offers": {}}
        self.bus.publish("lumen.NAO.ask", {**body, "passages": [], **more})
        ended = {"id": id}
        until(lambda: ended in self.answers.bodies)
        assert self.module.settle(HANG)  # it has told all
        return [{k: v for k, v in one.items() if k != "id"} for one in self.answers.bodies if one["id"] == id][:-1]

    def said(self, *arguments: Any, **more: Any) -> list[str]:
        return [one.get("text") for one in self.ask(*arguments, **more)]


@pytest.fixture
def desk(project: Project, monkeypatch: pytest.MonkeyPatch) -> Iterator[Callable[..., Desk]]:
    """Return a function that makes a desk with a model that replies as given."""
    monkeypatch.setenv("FAKE_KEY", "sk-secret")
    with ExitStack() as stack:

        def make(reply: Reply, **options: Any) -> Desk:
            model = stack.enter_context(fake_model(reply))
            made = Desk(with_model(project, model.url, **options), model)
            stack.callback(made.bus.close)
            stack.callback(made.module.close)
            return made

        yield make
