"""Ids and floods of one sender never make another sender's message a copy, lost or late."""

import json
import logging
import time
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from lumen.bus import connect
from lumen.bus.validated import validated
from lumen.features.rabbitmq import intake as taking
from lumen.features.rabbitmq.dispatcher import Dispatcher
from lumen.features.rabbitmq.intake import Intake
from lumen.features.rabbitmq.properties import MessageProperties
from lumen.features.rabbitmq.subscriptions import Delivery, Subscription
from lumen.language.causes import MessageOrigin
from lumen.language.commands import Rest, Say, Stop
from lumen.language.motions import MotionDefinition
from lumen.language.routes import USUAL_RATE, Carried, Direction, Route
from lumen.motion import bounds
from lumen.ports import Message, Perform, RobotCommand
from lumen.robot.command_receiver import ID_TAKEN, MAX_WAITING_COMMANDS, MAX_WAITING_OWN, RESTARTED, CommandListener
from lumen.robot.deduplication_log import DeduplicationLog
from lumen.robot.recording import RecordingRobot
from lumen.robot.remote import RobotHost
from lumen.upkeep.ratelimit import BURST, MAX_SENDERS, RateLimiter
from tests.exhibits import BODY, messages, project
from tests.tables import for_each
from tests.waiting import HANG, Collector

KEY = "museum.lamp.set"
LAMP = Route("lamp", KEY, Direction.IN, carried=Carried.COMMAND, must_arrive=True)


class Line:
    """A dispatcher that records its messages."""

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
        """End the dispatcher; return the bodies of the handled messages."""
        assert self.dispatcher.end(HANG)
        return [message.body for message in self.seen]


@for_each(
    ("first", "second", "handled", "dropped"),
    [
        ({"sender": "desk"}, {"sender": "door"}, [1, 1], 0),
        ({"sender": "desk"}, {"sender": ""}, [1, 1], 0),
        ({"sender": "desk"}, {"sender": "desk", "body": b"2"}, [1], 1),  # after a restart it counts from 1 again
        ({"sender": "desk"}, {"sender": "desk"}, [1], 1),
        ({"sender": ""}, {"sender": "", "body": b"2"}, [1], 1),
        ({"sender": "desk"}, {"sender": "desk", "body": b"2", "again": True}, [1], 1),
        ({"sender": "desk"}, {"sender": "desk", "again": True}, [1], 0),  # the broker has no confirmation of it
        ({"sender": "desk", "timestamp": 7}, {"sender": "desk", "timestamp": 7}, [1], 0),  # sent again after an outage
        ({"sender": "desk", "timestamp": 7}, {"sender": "desk", "timestamp": 9}, [1], 1),
    ],
)
def test_a_second_message_with_an_id_is_from_another_sender_or_refused(
    first: dict[str, Any], second: dict[str, Any], handled: list[int], dropped: int
) -> None:
    line = Line()
    line.come(id="1", **first)
    line.come(id="1", **second)
    assert line.end() == handled
    assert sum(line.dispatcher.repeated.counts.values()) == len(line.refused) == dropped
    assert len(line.handed) == 2, "each is acknowledged"


def test_a_stop_is_handled_with_any_id_unless_it_is_a_copy() -> None:
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
        f"messages on `{KEY}` are dropped: 'desk' has sent the id '1' before: give each message its own id"
    ]
    assert line.dispatcher.repeated.counts == {KEY: 49}


class Begun(CommandListener):
    def __init__(self) -> None:
        self.commands: list[RobotCommand] = []

    def given(self, command: RobotCommand, id: str) -> None:
        self.commands.append(command)

    def is_brains(self, id: str) -> bool:
        return id.startswith("session.")


class Stage:
    """A hosted recording robot, and modules that send it commands with the same id."""

    def __init__(self, keep: int | None = None) -> None:
        it = project(messages=messages())
        it = replace(it, routes={**it.routes, "command": replace(it.routes["command"], keep=keep)})
        self.robot, self.bus = RecordingRobot(BODY), validated(connect("memory://"), it)
        begun = Begun()
        self.begun = begun.commands
        self.host = RobotHost(it, self.robot, self.bus, self.robot, [begun])
        self.answers = Collector()
        self.bus.subscribe("lumen.me", self.answers)

    def send(self, sender: str, method: str, **parameter: object) -> None:
        body = {"type": "motion", "method": method, "parameter": parameter, "id": "1"}
        self.bus.publish("avatar.NAO.command", body, reply_to="lumen.me", origin=MessageOrigin(sender=sender))
        for _ in range(400):
            self.robot.advance(0.02)
            self.host.tick(self.robot.time)

    def receive(self, body: dict[str, Any], sender: str, id: str = "", at: float = 0.0) -> None:
        """Receive a message as from a bus, at the next tick."""
        self.host.server._orders._receive(Message("avatar.NAO.command", body, "lumen.me", "", id, sender, at))

    def tick(self) -> None:
        self.robot.advance(0.02)
        self.host.tick(self.robot.time)

    @property
    def stops(self) -> int:
        """The number of begun commands that stop the robot."""
        return sum(isinstance(command, Rest | Stop) for command in self.begun)

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


def test_a_stop_is_performed_with_any_id() -> None:
    stage = Stage()
    stage.send("desk", "say", text="Hello")
    stage.send("desk", "rest")
    assert any(isinstance(command, Rest) for _, command in stage.robot.performed)
    stage.host.close()


@for_each("method", ["stop", "stopMove", "rest"])
def test_a_stop_with_the_same_id_and_body_is_performed_again(method: str) -> None:
    stage = Stage()
    body = {"method": method, "id": "stop"}
    for sender, id, at in [
        ("panel", "m1", 1000.0),
        ("panel", "m2", 1060.0),
        ("panel", "m2", 1090.0),
        ("desk", "m1", 1.0),
    ]:
        stage.receive(body, sender, id, at)
        stage.tick()
    assert stage.stops == 4
    stage.host.close()


def test_a_stop_that_the_bus_delivers_again_is_performed_once() -> None:
    stage = Stage()
    for _ in range(2):
        stage.receive({"method": "stop", "id": "stop"}, "panel", "m1", 1000.0)
        stage.tick()
    assert stage.stops == 1
    assert stage.answers.bodies[-1] == {"id": "stop", "state": "finished", "method": "stop"}
    for _ in range(2):  # without an id of the message, it may be a new one
        stage.receive({"method": "stop", "id": "again"}, "panel")
        stage.tick()
    assert stage.stops == 3
    stage.host.close()


@for_each(
    ("line", "refused"),
    [
        (["1", "desk"], {"desk"}),
        (["1", ""], {""}),
        (["1"], {"desk", "door", ""}),  # an older version did not record the sender
    ],
)
def test_after_a_restart_an_id_is_taken_for_its_sender_and_never_for_a_stop(
    line: list[str], refused: set[str], tmp_path: Path
) -> None:
    file = tmp_path / "commands.jsonl"
    for sender in ("desk", "door", ""):
        file.write_text(json.dumps([time.time(), *line]) + "\n", "utf-8")
        stage = Stage()
        stage.host.server.recall(DeduplicationLog(file))
        stage.receive({"method": "say", "id": "1", "parameter": {"text": "Hello"}}, sender, "m1")
        stage.tick()
        assert (stage.begun == []) == (sender in refused)
        assert (stage.answers.bodies[-1].get("reason") == RESTARTED) == (sender in refused)
        stage.receive({"method": "stop", "id": "1"}, sender, "m2")
        stage.tick()
        assert stage.stops == 1
        stage.host.close()


def test_the_sender_of_a_begun_command_is_recorded(tmp_path: Path) -> None:
    stage = Stage()
    stage.host.server.recall(DeduplicationLog(tmp_path / "commands.jsonl"))
    stage.send("desk", "say", text="Hello")
    assert [command[1:] for command in DeduplicationLog(tmp_path / "commands.jsonl").before] == [("1", "desk")]
    stage.host.close()


def test_the_waiting_commands_of_the_behaviour_shut_out_no_stop_and_no_other_module() -> None:
    stage = Stage(keep=3)
    say = {"method": "say", "parameter": {"text": "Hello"}}
    for i in range(MAX_WAITING_OWN + 1):
        stage.receive({**say, "id": f"session.d{i}"}, "brain")
    assert stage.answers.bodies == [
        {"id": "session.d1000", "state": "failed", "method": "say", "reason": "1000 commands are waiting already"}
    ]
    for i in range(4):
        stage.receive({**say, "id": f"p{i}"}, "panel")
    assert [(body["id"], body["reason"]) for body in stage.answers.bodies[1:]] == [
        ("p3", "3 commands are waiting already")
    ]
    stage.receive({"method": "stop", "id": "s1"}, "panel")
    stage.receive({"method": "rest", "id": "session.s2"}, "brain")
    stage.tick()
    assert stage.stops == len(stage.begun) == 2
    stage.receive({**say, "id": "p4"}, "panel")
    stage.tick()
    assert stage.begun[2:] == [Say("Hello")], "there is room again"
    stage.host.close()


def test_a_motion_that_comes_with_each_play_is_analysed_once(monkeypatch: pytest.MonkeyPatch) -> None:
    analysed: list[MotionDefinition] = []
    monkeypatch.setattr(bounds, "_analysed", lambda motion, _body: analysed.append(motion) or (motion, (), True))
    stage = Stage()
    nod, bow = ({"name": name, "duration": 1.0, "tracks": {"HeadYaw": [[0.5, 0.1]]}} for name in ("nod", "bow"))
    for i, motion in enumerate([nod, bow, nod, bow]):
        stage.receive({"method": "perform", "id": f"p{i}", "parameter": {"motion": motion}}, "brain")
        stage.tick()
    assert [command.motion.name for command in stage.begun if isinstance(command, Perform)] == ["nod", "bow"] * 2
    for _ in range(250):  # each motion is analysed when it begins, after those before it
        stage.tick()
    assert [motion.name for motion in analysed] == ["nod", "bow"]
    stage.host.close()


def test_a_sender_gets_the_state_of_its_own_command_and_others_of_the_newest() -> None:
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


FLOOD = 40
"""The number of commands from a stranger in each tick: 2,000 a second."""


def flooded(stage: Stage, ticks: int) -> None:
    """Send a stranger's speech and lights for that many ticks."""
    for tick in range(ticks):
        for i in range(FLOOD):
            method, more = ("say", {"text": "Buy now"}) if i % 2 else ("leds", {"colours": {"eyes": "red"}})
            body = {"type": "motion", "method": method, "parameter": more, "id": f"{tick}.{i}"}
            stage.bus.publish("avatar.NAO.command", body, origin=MessageOrigin(sender="stranger"))
        stage.robot.advance(0.02)
        stage.host.tick(stage.robot.time)


def until_said(stage: Stage, text: str) -> list[str]:
    """Continue the flood until the robot says `text`, at most 15 s; return the texts said since the call."""
    before = len(stage.said)
    for _ in range(750):
        flooded(stage, 1)
        if text in stage.said[before:]:
            break
    return stage.said[before:]


def test_the_behaviours_speech_waits_only_for_the_text_under_way() -> None:
    stage = Stage()
    flooded(stage, 250)
    stage.robot.start("d1", Say("Welcome"))
    stage.robot.start("d2", Say("Come in"))
    assert until_said(stage, "Come in") in (["Welcome", "Come in"], ["Buy now", "Welcome", "Come in"])
    assert "Buy now" in until_said(stage, "Buy now"), "strangers are heard, too"
    assert stage.host.server._orders.drops.counts["avatar.NAO.command"] > 5_000
    stage.host.close()


def test_the_speech_of_a_remote_brain_waits_only_for_the_text_under_way() -> None:
    stage = Stage()
    flooded(stage, 250)
    for i in range(MAX_WAITING_COMMANDS):
        body = {"type": "motion", "method": "say", "parameter": {"text": "Buy now"}, "id": f"at once {i}"}
        stage.bus.publish("avatar.NAO.command", body, origin=MessageOrigin(sender="stranger"))
    body = {"type": "motion", "method": "say", "parameter": {"text": "Welcome"}, "id": "session.d1"}
    stage.bus.publish("avatar.NAO.command", body, origin=MessageOrigin(sender="brain"))
    assert until_said(stage, "Welcome") in (["Welcome"], ["Buy now", "Welcome"])
    stage.host.close()


def test_a_flood_of_one_sender_leaves_room_for_the_commands_of_others(monkeypatch: pytest.MonkeyPatch) -> None:
    now = [0.0]
    monkeypatch.setattr(taking, "RateLimiter", lambda: RateLimiter(lambda: now[0]))
    passed, refused = list[Delivery](), list[Delivery]()
    intake = Intake(passed.append, lambda delivery, _why: refused.append(delivery), lambda _seconds, _work: None)
    subscription = Subscription(KEY, None, LAMP)

    def come(sender: str) -> None:
        intake.take(Delivery(subscription, KEY, b"", MessageProperties(app_id=sender), 1, 1))

    def taken(sender: str) -> int:
        return sum(delivery.properties.app_id == sender and not delivery.spent for delivery in passed)

    for tick in range(250):
        for _ in range(FLOOD):
            come("stranger")
        if tick % 50 == 0:
            come("brain")
        now[0] += 0.02
    assert taken("brain") == 5
    assert taken("stranger") <= (BURST + 5) * USUAL_RATE
    assert intake.drops.counts[KEY] == 250 * FLOOD - taken("stranger")
    assert refused, "some are answered"
    before = len(passed)
    for i in range(10_000):
        come(f"stranger {i}")  # one sender under many names
    assert sum(not delivery.spent for delivery in passed[before:]) <= (MAX_SENDERS + 1) * BURST * USUAL_RATE
    now[0] += 2 * BURST
    come("a lamp")
    assert taken("a lamp") == 1
