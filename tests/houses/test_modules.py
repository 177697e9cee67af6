"""One process of modules serves both robots: each gets its own answers, and the recogniser is loaded once."""

import signal
from pathlib import Path

import pytest

from lumen.bus import connect
from lumen.features.ears.recogniser import Hypothesis
from lumen.features.ears.shared_recogniser import shared_sphinx
from lumen.features.ears.sphinx import Sphinx
from lumen.run.sound import Sound
from tests.houses.test_over_rabbitmq import Hall
from tests.rabbitmq import RabbitMQ
from tests.waiting import Collector, until

NAMES = ("ana", "ben")


def test_one_process_of_voice_and_memory_serves_both(
    stage: Path, broker: RabbitMQ, capsys: pytest.CaptureFixture[str]
) -> None:
    hall, bus = Hall(stage, broker.url, capsys), connect(broker.url)
    there, said, asked = Collector(), Collector(), Collector()
    bus.subscribe("lumen.*.presence", there)
    bus.subscribe("lumen.*.audio.text.to.speech", said)
    bus.subscribe("lumen.test.answer", asked)
    try:
        process, told = hall.begin("--only", "voice,memory")
        until(lambda: {body["robot"] for body in there.bodies if body["state"] == "here"} == {*NAMES})
        for name in NAMES:
            bus.publish(f"lumen.{name}.audio.text.stream", {"text": f"I am {name}", "language": "en", "name": name})
            fact = {"method": "remember", "name": f"Friend of {name}", "data": {}}
            bus.publish(f"lumen.{name}.persistence.fact", fact, reply_to="lumen.test.answer")
        said.wait(2)
        assert {message.key: message.body["name"] for message in said.messages} == {
            f"lumen.{name}.audio.text.to.speech": name for name in NAMES
        }
        assert [answer["ok"] for answer in asked.wait(2)] == [True, True]
        asked.messages.clear()
        bus.publish("lumen.ben.persistence.fact", {"method": "list"}, reply_to="lumen.test.answer")
        [answer] = asked.wait(1)
        assert [visitor["name"] for visitor in answer["visitors"]] == ["Friend of ben"], "each has its own visitors"
        hall.end(process, signal.SIGTERM)
        assert "ana: voice: 1 message" in told.read_text("utf-8")
    finally:
        bus.close()
        hall.close()


def test_the_recogniser_of_a_process_is_one(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[object] = []
    monkeypatch.setattr(Sphinx, "__init__", lambda self: asked.append(self))
    monkeypatch.setattr(Sphinx, "expect", lambda self, sentences: asked.append(sentences))
    monkeypatch.setattr(Sphinx, "hypotheses", lambda self, sound: [Hypothesis("hello")])
    ears = [shared_sphinx(), shared_sphinx()]
    ears[1].expect([["hello"]])
    assert [one.recognise(Sound(16_000, b"")) for one in ears] == ["hello", "hello"]
    assert asked[1:] == [(), [["hello"]]], "one was made, and each says what it expects"
