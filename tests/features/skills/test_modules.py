"""Skills that modules perform, over the bus: called, answered, cancelled, and given up without an answer."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from lumen.bus import connect
from lumen.features.skills import module_call, performer
from lumen.ports import Bus, Message
from lumen.project import load
from tests.features.skills.changing import project_in
from tests.features.skills.stage import Stage, stage
from tests.rabbitmq import RabbitMQ
from tests.waiting import UNLIMITED, until

MANIFEST = "in: {required: [litres], properties: {litres: {type: number}}}\nperformed-by: {module: pump}\n"


class Pump:
    """A module that performs `pump`; its `answers` are sent for each call."""

    def __init__(self, bus: Bus, *answers: Any) -> None:
        self.bus, self.answers, self.heard = bus, answers, list[Any]()
        bus.subscribe("lumen.NAO.skill.pump", self.take)

    def take(self, message: Message) -> None:
        self.heard.append(message.body)
        if "arguments" in message.body:
            for answer in self.answers:
                self.bus.publish("lumen.NAO.skill_answer", {"call": message.body["call"], **answer})
        elif "go" in message.body or "cancel" in message.body:
            self.bus.publish("lumen.NAO.skill_answer", {"call": message.body["call"], "result": {}})


@pytest.fixture
def pumping(tmp_path: Path) -> Iterator[Stage]:
    with stage(project_in(tmp_path, {"skills/pump.yaml": ("", MANIFEST)})) as made:
        yield made


def test_a_module_is_called_and_its_answer_is_the_result(pumping: Stage) -> None:
    pump = Pump(pumping.bus, {"progress": 0.5, "text": "half"}, {"result": {"litres": 2}}, {"result": {}})
    assert pumping.perform("pump", litres=2) == {"litres": 2}
    assert pumping.told == ["50% half"]
    (order,) = pump.heard
    assert (order["skill"], order["arguments"]) == ("pump", {"litres": 2})


def test_an_answer_of_a_module_wakes_the_call(pumping: Stage, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(performer, "LOOK", UNLIMITED)
    pump = Pump(pumping.bus, {"progress": 0.5, "text": "half"})
    id = pumping.start("pump", litres=1)
    pumping.until(lambda: pumping.told == ["50% half"])
    pumping.bus.publish("lumen.NAO.skill_answer", {"call": pump.heard[0]["call"], "result": {}})
    assert pumping.end(id) == {}


def test_a_module_waits_by_the_robots_clock(pumping: Stage) -> None:
    pump = Pump(pumping.bus, {"wait": 0.05})
    assert pumping.perform("pump", litres=1) == {}
    assert pump.heard[1] == {"call": pump.heard[0]["call"], "go": True}


def test_an_error_of_a_module_is_the_reason(pumping: Stage) -> None:
    Pump(pumping.bus, {"error": "the tank is empty"})
    assert pumping.perform("pump", litres=1) == "`pump` failed: the tank is empty"


def test_a_removed_skill_of_a_module_is_refused(pumping: Stage) -> None:
    pump = Pump(pumping.bus, {"result": {}})
    (pumping.root / "skills/pump.yaml").unlink()
    pumping.workshop.use(load(pumping.root))
    assert pumping.perform("pump", litres=1) == "the project has no skill `pump` any more"
    assert pump.heard == []


def test_a_module_hears_of_a_cancel(pumping: Stage, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(performer, "GRACE", UNLIMITED)  # a slow machine must not report it
    pump = Pump(pumping.bus, {"accepted": True})
    id = pumping.start("pump", litres=1)
    pumping.until(lambda: pump.heard)
    pumping.executor.cancel(id)
    assert pumping.end(id) == "cancelled"
    until(lambda: pump.heard[1:] == [{"call": pump.heard[0]["call"], "cancel": True}])
    assert pumping.reported == []


def test_a_module_that_ignores_a_cancel_is_reported(pumping: Stage) -> None:
    heard = list[Any]()
    pumping.bus.subscribe("lumen.NAO.skill.pump", heard.append)
    id = pumping.start("pump", litres=1)
    pumping.until(lambda: heard)
    pumping.executor.cancel(id)
    pumping.tick()
    assert id in pumping.events
    pumping.until_told("the module `pump` is given up: it did not end within 500 ms of its cancel")


def test_a_module_that_nobody_started_fails_the_skill(pumping: Stage, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module_call, "ACCEPTING", 0.1)
    reason = "the module `pump` is given up: it did not answer within 0.1 s: is it running, on this bus?"
    assert pumping.perform("pump", litres=1) == reason


@pytest.mark.broker
@pytest.mark.usefixtures("patient_bus")
def test_a_module_on_another_machine_is_called_over_rabbitmq(
    tmp_path: Path, broker: RabbitMQ, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(module_call, "ACCEPTING", UNLIMITED)
    root = project_in(tmp_path, {"skills/pump.yaml": ("", MANIFEST)})
    here, there = connect(broker.url), connect(broker.url)
    Pump(there, {"result": {"litres": 3}})
    with stage(root, here) as made:
        assert made.perform("pump", litres=3) == {"litres": 3}
    for bus in (here, there):
        bus.close()
