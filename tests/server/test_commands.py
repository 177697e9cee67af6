"""The server: commands that are answered."""

from dataclasses import replace
from typing import Any

import pytest

from lumen.bus import connect
from lumen.bus.validated import validated
from lumen.errors import BusError
from lumen.language.commands import Posture, Rest, Say
from lumen.language.events import Event
from lumen.language.motions import MotionDefinition
from lumen.ports import Aim, Message, Perform
from lumen.robot.command_table import speech_duration
from lumen.robot.recording import RecordingRobot
from lumen.robot.server import RobotServer
from lumen.run.sound import Sound, sound_of
from tests.exhibits import project
from tests.server.stand import PATIENT, PROJECT, Caller, Stand, without
from tests.waiting import Collector


def test_a_command_begins_at_the_next_tick_and_is_answered_when_it_is_over() -> None:
    stand = Stand()
    caller = Caller(stand)
    caller.order("goToPosture", postureName="Stand")
    assert stand.robot.started == []
    stand.server.sample(0.0)
    assert stand.robot.started == [("m1", Posture("Stand"))]
    assert caller.told == []
    assert not stand.server.answer(Event("done.command.c1"))
    assert not stand.server.answer(Event("touched", {"sensor": "ChestButton"}))
    assert stand.server.answer(Event("done.command.m1"))
    assert not stand.server.answer(Event("done.command.m1"))
    assert caller.told == [("7", "command finished")]
    stand.server.close()


def test_a_command_that_fails_or_is_cancelled_says_so() -> None:
    stand = Stand()
    caller = Caller(stand)
    caller.order("dance", "1")
    stand.server.sample(0.0)
    caller.order("rest", "2")
    stand.server.sample(0.02)
    assert [type(c).__name__ for _, c in stand.robot.started] == ["Perform", "Rest"]
    stand.server.answer(Event("cancelled.command.m1"))
    stand.server.answer(Event("error.command.m2", {"reason": "the robot has fallen"}))
    assert caller.told == [("1", "command cancelled"), ("2", "command failed: the robot has fallen")]
    stand.server.close()


def test_an_unknown_method_is_answered_and_logged(caplog: pytest.LogCaptureFixture) -> None:
    stand = Stand()
    caller = Caller(stand)
    caller.order("danse")
    stand.server.sample(0.0)
    assert caller.told == [("7", "command failed: there is no method `danse`: did you mean `dance`?")]
    assert "there is no method `danse`" in caplog.text
    assert stand.robot.started == []
    stand.server.close()


def test_what_is_over_at_once_is_answered_at_once() -> None:
    stand = Stand()
    caller = Caller(stand)
    caller.order("changeAngle", "1", jointNames=["HeadYaw"], angles=[0.1])
    caller.order("setLanguage", "2", language="Indonesian")
    caller.order("say", "3", text="Halo")
    caller.order("say", "4", text="Hello", language="English")
    stand.server.sample(0.0)
    assert caller.told == [("1", "command finished"), ("2", "command finished")]
    commands = [command for _, command in stand.robot.started]
    assert commands == [Aim({"HeadYaw": pytest.approx(0.2)}), Say("Halo", "id"), Say("Hello", "en")]
    stand.server.close()


def test_a_command_without_reply_to_is_performed_all_the_same() -> None:
    stand = Stand()
    stand.publish("avatar.NAO.command", {"method": "rest"})
    stand.server.sample(0.0)
    assert stand.robot.started == [("m1", Rest())]
    assert stand.server.answer(Event("done.command.m1"))
    stand.server.close()


def test_a_flood_of_commands_is_bounded_and_stopping_is_not_part_of_it() -> None:
    stand = Stand()
    caller = Caller(stand)
    for i in range(150):
        caller.order("leds", str(i), colours={"eyes": "red"})
    stand.server.sample(0.0)
    caller.order("rest", "stop")
    stand.server.sample(0.02)
    assert len(stand.robot.started) == 101
    assert stand.robot.started[-1] == ("m101", Rest())
    assert caller.told[0] == ("100", "command failed: 100 commands are waiting already")
    stand.server.close()


def test_everybody_in_a_flood_gets_an_answer(caplog: pytest.LogCaptureFixture) -> None:
    stand = Stand()
    stand.server._orders.drops._clock = lambda: stand.clock
    caller = Caller(stand)
    for i in range(1500):
        caller.order("leds", str(i), colours={"eyes": "red"})
    assert {text for _, text in caller.told} == {"command failed: 1000 commands are waiting already"}
    stand.server.sample(0.0)
    assert caller.told[-1] == ("999", "command failed: 100 commands are waiting already")
    for i in range(1, 101):
        stand.server.answer(Event(f"done.command.m{i}"))
    assert sorted(int(id) for id, _ in caller.told) == list(range(1500))
    stand.server.close()
    key = "avatar.NAO.command"
    assert [record.getMessage() for record in caplog.records] == [
        f"commands on `{key}` are dropped: 1000 commands are waiting already",
        "a command was refused: 100 commands are waiting already",
        f"more commands on `{key}` were dropped (1398 in 0 s): 100 commands are waiting already",
    ]


def test_nothing_waits_for_long_behind_a_flood() -> None:
    """The server takes as many texts and motions as are over in 15 s, and one more; it answers the others at once."""
    stand = Stand()
    caller = Caller(stand)
    for i in range(40):
        caller.order("say", f"say {i}", text="Nice to see you here, all of you!")
        caller.order("dance", f"dance {i}")
    stand.server.sample(0.0)
    said = [command for _, command in stand.robot.started if isinstance(command, Say)]
    assert 15.0 < sum(speech_duration(text.text) for text in said) < 20.0
    assert len([command for _, command in stand.robot.started if isinstance(command, Perform)]) == 16
    assert ("say 39", "command failed: earlier commands still take 17 s: send this one later, or `stop` them") in (
        caller.told
    )
    stand.server.answer(Event("done.command.m1"))
    caller.order("say", "long", text="la " * 1_000)
    caller.order("say", "next", text="Hello")
    stand.server.sample(0.02)
    assert caller.told[-1] == ("long", "command failed: this text takes 180 s to say: send one of at most 60 s")
    assert stand.robot.started[-1][1] == Say("Hello")
    stand.server.close()


def test_who_comes_just_before_the_end_gets_an_answer() -> None:
    stand = Stand()
    caller = Caller(stand)
    for i in range(5):
        caller.order("dance", str(i))
    receive = stand.server._orders._receive
    stand.server.close()
    receive(Message("avatar.NAO.command", {"method": "rest"}, "lumen.me", "late"))
    assert caller.told == [(id, "command failed: the robot accepts no more commands") for id in [*"01234", "late"]]
    assert stand.robot.started == []


def routed(**changes: Any) -> dict[str, Any]:
    """Return the project's routes, with these changes of the one for commands."""
    return {"routes": {**PROJECT.routes, "command": replace(PROJECT.routes["command"], **changes)}}


def test_a_command_that_waited_too_long_is_not_performed_but_stopping_is() -> None:
    stand = Stand(**routed(ttl=2.0))
    caller = Caller(stand)
    for id, method in [("1", "dance"), ("2", "rest"), ("3", "stopMove")]:
        caller.order(method, id)
    stand.clock = 1.5
    caller.order("sing", "4")
    stand.clock = 2.1
    stand.server.sample(0.0)
    assert caller.told == [("1", "command failed: it came too late")]
    assert [type(c).__name__ for _, c in stand.robot.started] == ["Rest", "Stop", "Perform"]
    stand.server.close()


def test_no_more_commands_wait_than_the_route_keeps_but_stopping_is_never_one_too_many() -> None:
    stand = Stand(**routed(keep=3))
    caller = Caller(stand)
    for i in range(5):
        caller.order("dance", str(i))
    caller.order("rest", "stop")
    told = [(i, "command failed: 3 commands are waiting already") for i in "34"]
    assert caller.told == told
    stand.server.sample(0.0)
    assert [type(c).__name__ for _, c in stand.robot.started] == ["Rest"]
    assert caller.told == [*told, *((i, "command cancelled") for i in "012")]
    caller.order("dance", "5")
    stand.server.sample(0.02)
    assert len(stand.robot.started) == 2
    stand.server.close()


def test_another_bundle_brings_its_own_key_for_commands() -> None:
    stand = Stand()
    stand.publish("avatar.NAO.command", {"method": "wakeup"})
    stand.server.use(project(**routed(key="avatar.{robot}.please")))
    stand.publish("avatar.NAO.command", {"method": "dance"})
    stand.publish("avatar.NAO.please", {"method": "sing"})
    stand.server.sample(0.0)
    assert [type(c).__name__ for _, c in stand.robot.started] == ["Wake", "Perform"]
    stand.server.close()
    assert len(stand.bus._mine) == 1  # type: ignore[attr-defined]


def test_where_the_bus_refuses_the_new_key_the_old_one_stays(caplog: pytest.LogCaptureFixture) -> None:
    stand = Stand()
    subscribe = stand.bus.subscribe

    def refuse(pattern: str, handler: Any) -> Any:
        raise BusError("you may not read that")

    stand.bus.subscribe = refuse  # type: ignore[method-assign]
    stand.server.use(project(**routed(key="avatar.{robot}.please")))
    stand.bus.subscribe = subscribe  # type: ignore[method-assign]
    stand.publish("avatar.NAO.command", {"method": "rest"})
    stand.server.sample(0.0)
    assert stand.robot.started == [("m1", Rest())]
    assert "commands are still accepted on the old key `avatar.NAO.command`: you may not read that" in caplog.text
    stand.server.close()


def test_who_waits_for_an_answer_gets_one_when_the_server_closes() -> None:
    stand = Stand()
    caller = Caller(stand)
    caller.order("dance")
    stand.server.sample(0.0)
    stand.server.close()
    assert caller.told == [("7", "command cancelled")]


def test_another_bundle_brings_its_own_periods_and_motions() -> None:
    stand = Stand(**without("image", "sonar", "tactile", "battery"))
    stand.live(0.6)
    routes = {**PROJECT.routes, "joint": replace(PROJECT.routes["joint"], every=0.3)}
    del routes["image"], routes["tactile"], routes["battery"]
    wave = MotionDefinition("wave", 1.0, {})
    stand.server.use(project(routes=routes, motions={"wave": wave}))
    for i in range(30, 60):
        stand.server.sample(i * 0.02)
        assert stand.server.settle(PATIENT)
    assert {s: c.published for s, c in stand.server.counts.items()} == {"joint": 12, "sonar": 6}
    stand.publish("avatar.NAO.command", {"method": "wave"})
    stand.server.sample(1.2)
    assert stand.robot.started == [("m1", Perform(wave))]
    stand.server.close()


def test_another_robots_commands_are_not_ours() -> None:
    stand = Stand()
    stand.publish("avatar.PEPPER.command", {"method": "rest"})
    stand.server.sample(0.0)
    assert stand.robot.started == []
    stand.server.close()


def test_after_closing_no_command_is_taken() -> None:
    stand = Stand()
    stand.server.close()
    stand.publish("avatar.NAO.command", {"method": "rest"})
    stand.server.sample(0.0)
    assert stand.robot.started == []


def test_a_recording_is_for_modules_and_on_its_own_route() -> None:
    robot = RecordingRobot(PROJECT.body)
    bus = validated(connect("memory://"), PROJECT)
    server, came, told = RobotServer(PROJECT, robot, bus), Collector(), Collector()
    bus.subscribe("avatar.NAO.data.recording", came)
    bus.subscribe("avatar.NAO.event.noticed", told)
    order = {"type": "audiodevice", "Method": "record", "parameter": {"recordingName": "r1", "duration": 0.5}}
    bus.publish("avatar.NAO.command", order)
    server.sample(0.0)
    for _ in range(60):
        robot.advance(0.02)
        for event in robot.poll():
            server.answer(event)
    server.close()
    [body] = came.bodies
    assert body["name"] == "r1"
    assert sound_of(body["content"]) == Sound(16_000, bytes(16_000))
    assert told.bodies == []
