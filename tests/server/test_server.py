"""The server: five senses, each on its own thread, and commands that are answered."""

import base64
import io
import threading
import time
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from PIL import Image as Picture

from lumen.bus import Bus, connect
from lumen.buses.checking import SchemaCheck
from lumen.buses.validated import validated
from lumen.errors import BusError, RobotError
from lumen.language.commands import Posture, Rest, Say
from lumen.language.events import Event
from lumen.language.motions import Motion
from lumen.language.projects import Project
from lumen.ports import Aim, Battery, Image, Joints, Message, Perform, Reading, RobotCommand, Sense, Sonar, Tactile
from lumen.robots.server import Server
from tests.exhibits import JOINTS, TACTILE, messages, project
from tests.waiting import Collector, until

PROJECT = project()
NAMES = tuple(JOINTS)
FRAME = np.zeros((240, 320, 3), np.uint8)
PATIENT = 20.0
DATE = "2015-06-01T09:30:00.000+00:00"


class Puppet:
    """A robot that says what a test wants it to say."""

    def __init__(self) -> None:
        self.now = 0.0
        self.started: list[tuple[str, RobotCommand]] = []
        self.reads: list[Sense] = []
        self.pixels: Any = lambda: FRAME

    def start(self, id: str, command: RobotCommand) -> None:
        self.started.append((id, command))

    def cancel(self, id: str) -> None: ...

    def poll(self) -> Sequence[Event]:
        return ()

    def begun(self) -> Sequence[str]:
        return ()

    def read(self, sense: Sense) -> Reading | None:
        self.reads.append(sense)
        match sense:
            case Sense.IMAGE:
                return Image(self.now, self.pixels)
            case Sense.JOINT:
                return Joints(self.now, NAMES, (0.1,) * len(NAMES), (1.0,) * len(NAMES))
            case Sense.SONAR:
                return Sonar(self.now, left=0.5, right=2.55)
            case Sense.TACTILE:
                return Tactile(self.now, TACTILE, (1,) + (0,) * 11)
            case Sense.BATTERY:
                return Battery(self.now, 80, plugged=False, charging=True)

    def close(self) -> None: ...


class Stand:
    """A server with its puppet, its bus, and all that is said on it."""

    def __init__(self, bus: Bus | None = None, **changes: Any) -> None:
        self.robot, self.bus, self.heard = Puppet(), bus or connect("memory://"), Collector()
        self.bus.subscribe("avatar.NAO.data.#", self.heard)
        self.clock = 0.0
        self.server = Server(project(**changes), self.robot, self.bus, date=lambda: DATE, clock=lambda: self.clock)

    def live(self, seconds: float, tick: float = 0.02) -> None:
        for i in range(round(seconds / tick)):
            self.robot.now = i * tick
            self.server.sample(self.robot.now)
            assert self.server.settle(PATIENT)

    def of(self, sense: str) -> list[Any]:
        return [m.body for m in list(self.heard.messages) if m.key == f"avatar.NAO.data.{sense}"]


def without(*senses: str) -> dict[str, Any]:
    return {"routes": {name: route for name, route in PROJECT.routes.items() if name not in senses}}


def test_bodies_are_those_of_2015_and_the_time() -> None:
    stand = Stand()
    stand.live(0.02)
    stand.server.close()
    assert stand.of("joint") == [{"name": list(NAMES), "angle": [0.1] * 5, "stiffness": [1.0] * 5, "time": 0.0}]
    assert stand.of("sonar") == [{"rightSensor": 2.55, "leftSensor": 0.5, "time": 0.0}]
    assert stand.of("tactile") == [{"name": list(TACTILE), "value": [1] + [0] * 11, "time": 0.0}]
    assert stand.of("battery") == [{"percentage": 80, "isPlugged": False, "isCharging": True, "time": 0.0}]
    schemas = messages()
    for sense in Sense:
        (body,) = stand.of(sense)
        assert SchemaCheck(schemas[sense])(body) == ""


def test_an_image_is_a_jpeg_in_a_data_uri() -> None:
    stand = Stand()
    frame = FRAME.copy()
    frame[:, :, 0] = 200
    stand.robot.pixels = lambda: frame
    stand.server.sample(0.0)
    stand.server.close()
    (body,) = stand.of("image")
    data = base64.b64decode(body["contentUrl"].removeprefix("data:image/jpeg;base64,"))
    picture = Picture.open(io.BytesIO(data))
    assert (picture.format, picture.size) == ("JPEG", (320, 240))
    assert picture.getpixel((160, 120))[0] == pytest.approx(200, abs=4)
    assert body["contentSize"] == len(data)
    assert {body[k] for k in ("uploadDate", "dateCreated", "dateModified", "datePublished")} == {DATE}
    assert (body["name"], body["contentType"], body["time"]) == ("0", "image/jpeg", 0.0)


def test_every_sense_keeps_its_own_period() -> None:
    stand = Stand(**without("image"))
    stand.live(6.0)
    counts = {sense: count.published for sense, count in stand.server.counts.items()}
    assert counts == {"joint": 100, "sonar": 60, "tactile": 60, "battery": 6}
    gaps = np.diff([body["time"] for body in stand.of("joint")])
    assert gaps.max() <= 0.0601 + 0.02
    stand.server.close()


def test_ticks_coarser_than_a_period_read_once_a_tick() -> None:
    stand = Stand(**without("image"))
    stand.live(10.0, tick=1.0)
    assert stand.server.counts["joint"].published == 10
    stand.server.close()


def test_the_same_samples_leave_in_the_same_order() -> None:
    stand = Stand(**without("image"))
    stand.live(2.0)
    keys = [m.key.rpartition(".")[2] for m in stand.heard.messages]
    assert keys[:4] == ["joint", "sonar", "tactile", "battery"]
    again = Stand(**without("image"))
    again.live(2.0)
    assert [m.key for m in again.heard.messages] == [m.key for m in stand.heard.messages]


def test_each_sense_publishes_from_a_thread_of_its_own() -> None:
    stand, threads = Stand(), {}
    stand.bus.subscribe("avatar.NAO.data.#", lambda m: threads.setdefault(m.key, threading.current_thread().name))
    stand.server.sample(0.0)
    stand.server.close()
    assert threads == {f"avatar.NAO.data.{sense}": f"lumen-{sense}" for sense in Sense}


def test_a_camera_that_is_slow_keeps_nobody_waiting_and_the_newest_frame_wins() -> None:
    stand, inside, release = Stand(), threading.Event(), threading.Event()

    def slow() -> np.ndarray:
        inside.set()
        assert release.wait(20)
        return FRAME

    stand.robot.pixels = slow
    stand.server.sample(0.0)
    assert inside.wait(20)
    for i in range(1, 50):
        stand.robot.now = i * 0.02
        stand.server.sample(stand.robot.now)
        assert stand.server.settle(PATIENT)
    release.set()
    stand.server.close()
    count = stand.server.counts["image"]
    assert len(stand.of("joint")) == 17
    assert [body["time"] for body in stand.of("image")] == [0.0, pytest.approx(0.94, abs=0.05)]
    assert (count.published, count.dropped) == (2, stand.robot.reads.count(Sense.IMAGE) - 2)


def test_without_opengl_the_camera_is_switched_off_with_one_line(caplog: pytest.LogCaptureFixture) -> None:
    stand = Stand()

    def blind() -> np.ndarray:
        raise RobotError("there is no OpenGL: install libegl1")

    stand.robot.pixels = blind
    stand.server.sample(0.0)
    until(lambda: stand.server.counts["image"].off)
    stand.live(1.0)
    stand.server.close()
    assert stand.robot.reads.count(Sense.IMAGE) == 1
    assert [r.getMessage() for r in caplog.records] == [
        "the sense `image` is switched off: there is no OpenGL: install libegl1"
    ]
    assert len(stand.of("joint")) == 17


def test_another_bundle_gives_the_camera_another_chance() -> None:
    stand = Stand()

    def blind() -> np.ndarray:
        raise RobotError("there is no OpenGL")

    stand.robot.pixels = blind
    stand.server.sample(0.0)
    until(lambda: stand.server.counts["image"].off)
    stand.robot.pixels = lambda: FRAME
    stand.server.use(project())
    stand.server.sample(0.1)
    until(lambda: stand.server.counts["image"].published == 1)
    assert stand.server.counts["image"].off == ""
    before = threading.active_count()
    stand.server.close()
    assert threading.active_count() == before - 5


def wrong(sense: str) -> Project:
    """A project whose message schema does not fit the bodies of that sense."""
    return project(messages={**PROJECT.messages, sense: {"required": ["nobody has this"]}})


def test_a_refused_body_costs_that_body_alone_and_a_repaired_schema_is_enough(
    caplog: pytest.LogCaptureFixture,
) -> None:
    bus = validated(connect("memory://"), wrong("joint"))
    stand = Stand(bus=bus, **without("image"))
    stand.live(0.6)
    counts = stand.server.counts
    assert (counts["joint"].published, counts["joint"].refused, counts["joint"].off) == (0, 10, "")
    assert counts["sonar"].published == 6
    assert [r.getMessage() for r in caplog.records] == [
        "a reading of the sense `joint` was refused: a message on `avatar.NAO.data.joint` can't be sent:"
        " 'nobody has this' is a required property"
    ]
    bus.use(PROJECT)
    for i in range(30, 60):
        stand.server.sample(i * 0.02)
        assert stand.server.settle(PATIENT)
    assert (counts["joint"].published, counts["joint"].refused) == (10, 10)
    stand.server.close()


def test_the_numbers_in_a_reason_make_no_new_one(caplog: pytest.LogCaptureFixture) -> None:
    bus = connect("memory://")
    stand = Stand(bus=bus, **without("image", "sonar", "tactile", "battery"))

    def refuse(key: str, body: Any, **_: Any) -> None:
        raise BusError(f"{body['time']} is too late")

    bus.publish = refuse  # type: ignore[method-assign]
    stand.live(0.6)
    assert len(caplog.records) == 1
    stand.server.use(project(**without("image", "sonar", "tactile", "battery")))
    stand.server.sample(1.0)
    assert stand.server.settle(PATIENT)
    stand.server.close()
    assert len(caplog.records) == 2


def test_a_slow_subscriber_keeps_the_loop_waiting_for_a_tick_at_most() -> None:
    stand, inside, release = Stand(**without("image")), threading.Event(), threading.Event()

    def slow(message: Message) -> None:
        inside.set()
        assert release.wait(20)

    stand.bus.subscribe("avatar.NAO.data.joint", slow)
    stand.server.sample(0.0)
    assert inside.wait(20)
    began, processor = time.monotonic(), time.process_time()
    assert not any(stand.server.settle() for _ in range(50))
    assert time.monotonic() - began < 0.5
    assert time.process_time() - processor < 0.5
    for i in range(1, 50):
        stand.server.sample(i * 0.02)
    assert len(stand.server._leaving) <= 8
    release.set()
    assert stand.server.settle(PATIENT)
    stand.server.close()


def test_a_thread_that_the_machine_holds_back_is_waited_for() -> None:
    stand, release = Stand(**without("image", "sonar", "tactile", "battery")), threading.Event()
    encode = stand.server._broadcasts[Sense.JOINT]._encode

    def held(reading: Reading) -> dict[str, Any]:
        assert release.wait(20)
        return encode(reading)

    stand.server._broadcasts[Sense.JOINT]._encode = held
    stand.server.sample(0.0)
    threading.Timer(0.1, release.set).start()
    assert stand.server.settle()
    assert len(stand.of("joint")) == 1
    stand.server.close()


def test_a_robot_without_a_sense_is_no_trouble() -> None:
    stand = Stand()
    stand.robot.read = lambda sense: None  # type: ignore[method-assign]
    stand.live(0.1)
    stand.server.close()
    assert stand.heard.messages == []


def test_closing_ends_the_threads_and_may_be_repeated() -> None:
    before = threading.active_count()
    stand = Stand()
    assert threading.active_count() == before + 5
    stand.live(0.1)
    stand.server.close()
    stand.server.close()
    assert threading.active_count() == before


class Caller:
    """A module that gives commands and waits for answers."""

    def __init__(self, stand: Stand) -> None:
        self.stand, self.answers = stand, Collector()
        stand.bus.subscribe("lumen.me", self.answers)

    def order(self, method: str, id: str = "7", **parameter: Any) -> None:
        body = {"type": "motion", "Method": method, "parameter": parameter}
        self.stand.bus.publish("avatar.NAO.command", body, reply_to="lumen.me", correlation_id=id)

    @property
    def told(self) -> list[tuple[str, str]]:
        return [(m.correlation_id, m.body) for m in self.answers.messages]


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
    stand.bus.publish("avatar.NAO.command", {"method": "rest"})
    stand.server.sample(0.0)
    assert stand.robot.started == [("m1", Rest())]
    assert stand.server.answer(Event("done.command.m1"))
    stand.server.close()


def test_a_flood_of_commands_is_bounded_and_stopping_is_not_part_of_it() -> None:
    stand = Stand()
    caller = Caller(stand)
    for i in range(150):
        caller.order("dance", str(i))
    stand.server.sample(0.0)
    caller.order("rest", "stop")
    stand.server.sample(0.02)
    assert len(stand.robot.started) == 101
    assert stand.robot.started[-1] == ("m101", Rest())
    assert caller.told[0] == ("100", "command failed: 100 commands are waiting already")
    stand.server.close()


def test_everybody_in_a_flood_gets_an_answer(caplog: pytest.LogCaptureFixture) -> None:
    stand = Stand()
    caller = Caller(stand)
    for i in range(1500):
        caller.order("say", str(i), text="hello")
    assert {text for _, text in caller.told} == {"command failed: 1000 commands are waiting already"}
    stand.server.sample(0.0)
    assert caller.told[-1] == ("999", "command failed: 100 commands are waiting already")
    for i in range(1, 101):
        stand.server.answer(Event(f"done.command.m{i}"))
    assert sorted(int(id) for id, _ in caller.told) == list(range(1500))
    assert caplog.text.count("500 commands were refused: too many came at once") == 1
    stand.server.close()


def test_who_comes_just_before_the_end_gets_an_answer() -> None:
    stand = Stand()
    caller = Caller(stand)
    for i in range(5):
        caller.order("dance", str(i))
    receive = stand.server._orders._receive
    stand.server.close()
    receive(Message("avatar.NAO.command", {"method": "rest"}, "lumen.me", "late"))
    assert caller.told == [(id, "command failed: the robot takes no more commands") for id in [*"01234", "late"]]
    assert stand.robot.started == []


def routed(**changes: Any) -> dict[str, Any]:
    """The project's routes, that of commands otherwise."""
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
    stand.bus.publish("avatar.NAO.command", {"method": "wakeup"})
    stand.server.use(project(**routed(key="avatar.{robot}.please")))
    stand.bus.publish("avatar.NAO.command", {"method": "dance"})
    stand.bus.publish("avatar.NAO.please", {"method": "sing"})
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
    stand.bus.publish("avatar.NAO.command", {"method": "rest"})
    stand.server.sample(0.0)
    assert stand.robot.started == [("m1", Rest())]
    assert "commands are still taken under `avatar.NAO.command`: you may not read that" in caplog.text
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
    wave = Motion("wave", 1.0, {})
    stand.server.use(project(routes=routes, motions={"wave": wave}))
    for i in range(30, 60):
        stand.server.sample(i * 0.02)
        assert stand.server.settle(PATIENT)
    assert {s: c.published for s, c in stand.server.counts.items()} == {"joint": 12, "sonar": 6}
    stand.bus.publish("avatar.NAO.command", {"method": "wave"})
    stand.server.sample(1.2)
    assert stand.robot.started == [("m1", Perform(wave))]
    stand.server.close()


def test_another_robots_commands_are_not_ours() -> None:
    stand = Stand()
    stand.bus.publish("avatar.PEPPER.command", {"method": "rest"})
    stand.server.sample(0.0)
    assert stand.robot.started == []
    stand.server.close()


def test_after_closing_no_command_is_taken() -> None:
    stand = Stand()
    stand.server.close()
    stand.bus.publish("avatar.NAO.command", {"method": "rest"})
    stand.server.sample(0.0)
    assert stand.robot.started == []


@pytest.mark.xdist_group("rabbitmq")
def test_the_same_server_on_a_broker(request: pytest.FixtureRequest) -> None:
    broker = request.getfixturevalue("broker")
    bus, module = connect(broker.url, PROJECT), connect(broker.url)
    senses, answers = Collector(), Collector()
    module.subscribe("avatar.NAO.data.*", senses)
    module.subscribe("lumen.me", answers)
    server = Server(replace(PROJECT), Puppet(), bus)
    module.publish("avatar.NAO.command", {"Method": "rest"}, reply_to="lumen.me", correlation_id="9")
    until(lambda: server.sample(time.monotonic()) or server.answer(Event("done.command.m1")))
    answers.wait(1)
    senses.wait(5)
    server.close()
    bus.close()
    module.close()
    assert {m.key.rpartition(".")[2] for m in senses.messages} == set(Sense)
    assert [(m.body, m.correlation_id) for m in answers.messages] == [("command finished", "9")]
