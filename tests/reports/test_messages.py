"""Ids of messages and commands are those of their senders; what is dropped for an id is counted and answered."""

import logging
from dataclasses import replace
from typing import Any

import pytest

from lumen.bus import connect
from lumen.buses.dispatcher import Dispatcher
from lumen.buses.properties import MessageProperties
from lumen.buses.subscriptions import Delivery, Subscription
from lumen.buses.validated import validated
from lumen.language.causes import MessageOrigin
from lumen.language.commands import Rest, Say
from lumen.language.routes import Carried, Direction, Route
from lumen.ports import Message
from lumen.robots.command_receiver import ID_TAKEN
from lumen.robots.recording import RecordingRobot
from lumen.robots.remote import RobotHost
from tests.exhibits import BODY, messages, project
from tests.tables import for_each
from tests.waiting import HANG, Collector

KEY = "museum.lamp.set"
LAMP = Route("lamp", KEY, Direction.IN, carried=Carried.COMMAND, must_arrive=True)


class Line:
    """A dispatcher, and what came through it."""

    def __init__(self, route: Route = LAMP) -> None:
        self.seen: list[Message] = []
        self.refused: list[str] = []
        self.handed: list[Delivery] = []
        self.dispatcher = Dispatcher(self.handed.append, lambda _delivery, reason: self.refused.append(reason))
        self.subscription = Subscription(KEY, self.seen.append, route)

    def come(self, sender: str, id: str, body: bytes = b"1", *, again: bool = False, timestamp: int = 0) -> None:
        said = MessageProperties(message_id=id, app_id=sender, timestamp=timestamp)
        self.dispatcher.receive(Delivery(self.subscription, KEY, body, said, 1, 1, again, at=float("inf")))

    def end(self) -> list[object]:
        """What was handled."""
        assert self.dispatcher.end(HANG)
        return [message.body for message in self.seen]


@for_each(
    ("first", "second", "handled", "dropped"),
    [
        ({"sender": "desk"}, {"sender": "door"}, [1, 1], 0),
        ({"sender": "desk"}, {"sender": ""}, [1, 1], 0),
        ({"sender": "desk"}, {"sender": "desk", "body": b"2"}, [1], 1),  # it counts from 1 since its restart
        ({"sender": "desk"}, {"sender": "desk"}, [1], 1),
        ({"sender": ""}, {"sender": "", "body": b"2"}, [1], 1),
        ({"sender": "desk"}, {"sender": "desk", "body": b"2", "again": True}, [1], 1),
        ({"sender": "desk"}, {"sender": "desk", "again": True}, [1], 0),  # the broker has it confirmed by nobody
        ({"sender": "desk", "timestamp": 7}, {"sender": "desk", "timestamp": 7}, [1], 0),  # sent again in an outage
        ({"sender": "desk", "timestamp": 7}, {"sender": "desk", "timestamp": 9}, [1], 1),
    ],
)
def test_a_second_message_of_an_id_is_told_apart_by_its_sender_or_counted_and_refused(
    first: dict[str, Any], second: dict[str, Any], handled: list[int], dropped: int
) -> None:
    line = Line()
    line.come(id="1", **first)
    line.come(id="1", **second)
    assert line.end() == handled
    assert sum(line.dispatcher.repeated.counts.values()) == len(line.refused) == dropped
    assert len(line.handed) == 2, "each is acknowledged"


def test_a_stop_is_handled_whatever_its_id_unless_it_is_a_copy() -> None:
    line = Line(replace(LAMP, carried=Carried.STOP))
    line.come("desk", "1")
    line.come("desk", "1", b"2")
    line.come("desk", "1")
    line.come("desk", "2", timestamp=7)
    line.come("desk", "2", timestamp=7)
    assert line.end() == [1, 2, 1, 1]
    assert line.refused == []


def test_the_first_of_many_repeated_ids_is_logged_with_what_to_do(caplog: pytest.LogCaptureFixture) -> None:
    line = Line()
    with caplog.at_level(logging.WARNING):
        for _ in range(50):
            line.come("desk", "1")
        line.end()
    assert caplog.messages == [
        f"messages on `{KEY}` are dropped: 'desk' has sent the id '1' before: give each message an id of its own"
    ]
    assert line.dispatcher.repeated.counts == {KEY: 49}


class Stage:
    """A hosted recording robot, and modules that send it commands of one id."""

    def __init__(self) -> None:
        it = project(messages=messages())
        self.robot, self.bus = RecordingRobot(BODY), validated(connect("memory://"), it)
        self.host = RobotHost(it, self.robot, self.bus, self.robot)
        self.answers = Collector()
        self.bus.subscribe("lumen.me", self.answers)

    def send(self, sender: str, method: str, **parameter: object) -> None:
        body = {"type": "motion", "method": method, "parameter": parameter, "id": "1"}
        self.bus.publish("avatar.NAO.command", body, reply_to="lumen.me", origin=MessageOrigin(sender=sender))
        for _ in range(400):
            self.robot.advance(0.02)
            self.host.tick(self.robot.time)

    @property
    def said(self) -> list[str]:
        return [command.text for _, command in self.robot.performed if isinstance(command, Say)]


def test_commands_of_two_senders_with_one_id_are_both_performed() -> None:
    stage = Stage()
    for sender, text in [("desk", "Hello"), ("door", "Hello"), ("desk", "Hello"), ("desk", "Bye")]:
        stage.send(sender, "say", text=text)
    assert stage.said == ["Hello", "Hello"]
    assert stage.answers.bodies[-1] == {"id": "1", "state": "failed", "method": "say", "reason": ID_TAKEN}
    assert stage.host.server._orders.drops.counts == {"avatar.NAO.command": 1}
    stage.host.close()


def test_a_stop_is_performed_whatever_its_id() -> None:
    stage = Stage()
    stage.send("desk", "say", text="Hello")
    stage.send("desk", "rest")
    assert any(isinstance(command, Rest) for _, command in stage.robot.performed)
    stage.host.close()


def test_the_sender_of_a_command_is_told_of_its_own_and_others_of_the_newest() -> None:
    stage = Stage()
    stage.send("desk", "say", text="Hello")
    stage.send("door", "danse")
    states = []
    for sender in ("desk", "door", "a terminal"):
        body = {"type": "motion", "method": "outcome", "parameter": {"id": "1"}}
        stage.bus.publish("avatar.NAO.command", body, reply_to="lumen.me", origin=MessageOrigin(sender=sender))
        stage.host.tick(stage.robot.time)
        states.append(stage.answers.bodies[-1]["state"])
    assert states == ["finished", "failed", "failed"]
    stage.host.close()
