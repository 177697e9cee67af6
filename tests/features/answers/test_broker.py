"""The brain and the module `answers` on two connections of a broker, as in processes of their own."""

from collections.abc import Iterator

import pytest

from lumen.bus import connect
from lumen.features.answers.module import Answers
from lumen.language.causes import UNKNOWN_ORIGIN
from lumen.language.commands import Ask
from lumen.language.events import Event
from lumen.language.projects import Project
from lumen.run.questions import Questions
from tests.features.answers.conftest import with_model
from tests.features.answers.fake_model import FakeModel, fake_model, says
from tests.rabbitmq import RabbitMQ
from tests.waiting import until

UNKNOWN = Ask("would you like to live on the moon", "en", 30.0)


@pytest.fixture
def model(monkeypatch: pytest.MonkeyPatch) -> Iterator[FakeModel]:
    monkeypatch.setenv("FAKE_KEY", "sk-secret")
    with fake_model(says("I do not know. ", "It is far.")) as made:
        yield made


def test_a_question_finds_its_answer(broker: RabbitMQ, project: Project, model: FakeModel) -> None:
    ready = with_model(project, model.url)
    brain, other = connect(broker.url, ready), connect(broker.url, ready)
    questions, told = Questions(brain), list[str]()
    try:
        questions.listen(ready)
        module = Answers(ready, other, told.append)
        module.begin()
        try:
            assert questions.ask(ready, "d2", UNKNOWN, 0.0, UNKNOWN_ORIGIN) == []
            found: list[Event] = []

            def ended() -> bool:
                found.extend(questions.drain(1.0))
                return any(event.name.startswith("done.") for event in found)

            until(ended)
        finally:
            module.close()
    finally:
        brain.close()
        other.close()
    assert [event.name for event in found] == ["answer.command.d2", "answer.command.d2", "done.command.d2"]
    assert [event.data["text"] for event in found[:2]] == ["I do not know.", "It is far."]
    assert all(event.cause and event.cause.key == "lumen.NAO.answer" for event in found)
    assert (told, len(model.requests)) == ([], 1)
