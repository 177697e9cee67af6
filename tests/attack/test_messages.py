"""Hostile messages against a running exhibition: it still ticks, speaks and stops."""

import json
from collections.abc import Iterator
from random import Random
from typing import Any

import pytest

from lumen.bus import connect
from lumen.errors import BadMessageError
from lumen.language.commands import Rest
from lumen.robot.command_receiver import CommandReceiver
from lumen.run.exhibition import Exhibition
from lumen.run.plan import Plan
from lumen.run.setup import set_up
from lumen.upkeep.threads import ThreadWatch
from tests.attack.messages import BODIES, FRAMES, HostileMessage, Stranger, encoded, frame, message
from tests.exhibits import project
from tests.rabbitmq import RabbitMQ
from tests.waiting import Collector, until

COUNT = 400


@pytest.fixture
def exhibition(broker: RabbitMQ) -> Iterator[Exhibition]:
    """An exhibition on a broker that runs as fast as possible."""
    exhibit = project()
    options = {"operated": False}
    whole = Exhibition(Plan(exhibit, set_up("recording", exhibit, "max"), broker.url, options=options))
    assert whole.services.presence
    whole.services.presence.settle()
    whole.tick()
    yield whole
    whole.close()


def test_the_same_seed_gives_the_same_messages() -> None:
    once, again = ([message(Random(7), {"lumen.a": {"x": 1}}) for _ in range(3)] for _ in range(2))
    assert once == again
    for make in (*BODIES, lambda random: b"".join(make(random, ["lumen.a"]) for make in FRAMES)):
        assert all(isinstance(make(Random(seed)), bytes) for seed in range(30))
    assert isinstance(frame(Random(1), ["lumen.a"]), bytes)


def test_no_message_ends_a_running_exhibition_nor_makes_it_deaf(
    exhibition: Exhibition, broker: RabbitMQ, caplog: pytest.LogCaptureFixture
) -> None:
    random, robot = Random(1), exhibition.services.setup.robot
    sound = dict.fromkeys(route.key_for(exhibition.project.robot) for route in exhibition.project.routes.values())
    stranger, friend, watch = Stranger(broker.url), Stranger(broker.url), ThreadWatch()
    for n in range(COUNT):
        stranger.send(message(random, sound))
        if n % 20 == 0:
            exhibition.tick()
    performed = robot.performed  # type: ignore[attr-defined]

    def obeyed(key: str, body: Any, kind: type) -> None:
        before = len(performed)
        friend.send(HostileMessage(key, json.dumps(body).encode(), encoded()))
        until(lambda: exhibition.tick() and any(isinstance(c, kind) for _, c in performed[before:]))

    obeyed("avatar.NAO.stop", {"type": "motion", "method": "rest"}, Rest)
    assert watch.tick() == []
    assert "Traceback" not in caplog.text, "no fault of ours"
    stranger.close()
    friend.close()


def test_every_body_that_may_come_gets_an_answer_or_none_but_never_a_fault(caplog: pytest.LogCaptureFixture) -> None:
    """A body is not checked before use if the project's routes have no schemas."""
    exhibit, random, answers = project(), Random(3), Collector()
    bus, setup = connect("memory://"), set_up("recording", exhibit, "max")
    receiver = CommandReceiver(exhibit, setup.robot, bus)
    bus.subscribe("lumen.answer", answers)
    for _ in range(COUNT):
        try:
            body = json.loads(message(random, {"avatar.NAO.command": None}).body)
        except (ValueError, RecursionError):
            continue
        for key in ("avatar.NAO.command", "avatar.NAO.stop", "avatar.NAO.aim"):
            try:
                bus.publish(key, body, reply_to="lumen.answer")
            except BadMessageError:
                continue
        receiver.begin()
        for event in setup.robot.poll():
            receiver.answer(event)
    assert receiver.guard.drops.counts == {}
    assert "Traceback" not in caplog.text
    receiver.close()
