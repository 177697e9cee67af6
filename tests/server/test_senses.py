"""The server: five senses, each on its own thread."""

import base64
import io
import threading
import time
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from PIL import Image as Picture

from lumen.bus import connect
from lumen.bus.checking import SchemaCheck
from lumen.bus.validated import validated
from lumen.errors import BusError, RobotError
from lumen.language.events import Event
from lumen.language.projects import Project
from lumen.language.routes import SIZES
from lumen.ports import Message, Reading, Sense
from lumen.robot.server import RobotServer
from tests.exhibits import TACTILE, messages, project
from tests.rabbitmq import RabbitMQ
from tests.server.stand import DATE, FRAME, NAMES, PATIENT, PROJECT, Puppet, Stand, delivered, without
from tests.waiting import HANG, Collector, threads, until


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


def test_the_route_says_how_large_an_image_is_and_a_reload_changes_that() -> None:
    route, asked = PROJECT.routes["image"], Collector()
    stand = Stand(routes={"image": replace(route, size=SIZES[2])})
    stand.robot.pixels = lambda size=None: (asked(size), FRAME)[1]
    stand.server.sample(0.0)
    until(lambda: stand.server.counts["image"].published == 1)
    stand.server.use(project(routes={"image": replace(route, size=SIZES[0])}))
    stand.server.sample(1.0)
    until(lambda: stand.server.counts["image"].published == 2)
    stand.server.close()
    assert asked.messages == [(640, 480), (160, 120)]


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


@pytest.mark.parametrize("direct", [False, True])
def test_the_same_samples_leave_in_the_same_order(direct: bool) -> None:
    stand = Stand(direct=direct, **without("image"))
    stand.live(2.0)
    delivered(stand.bus)
    keys = [m.key.rpartition(".")[2] for m in stand.heard.messages]
    assert keys[:4] == ["joint", "sonar", "tactile", "battery"]
    again = Stand(**without("image"))
    again.live(2.0)
    delivered(again.bus)
    assert [m.key for m in again.heard.messages] == [m.key for m in stand.heard.messages]
    for each in (stand, again):
        each.server.close()


def test_each_sense_publishes_from_a_thread_of_its_own() -> None:
    stand, threads = Stand(), {}
    stand.bus.subscribe("avatar.NAO.data.#", lambda m: threads.setdefault(m.key, threading.current_thread().name))
    stand.server.sample(0.0)
    stand.server.close()
    assert threads == {f"avatar.NAO.data.{sense}": f"lumen-{sense}" for sense in Sense}


def test_where_time_waits_readings_but_images_are_published_by_who_samples() -> None:
    stand, threads, me = Stand(direct=True), {}, threading.current_thread().name
    stand.bus.subscribe("avatar.NAO.data.#", lambda m: threads.setdefault(m.key, threading.current_thread().name))
    stand.server.sample(0.0)
    assert {threads[f"avatar.NAO.data.{sense}"] for sense in set(Sense) - {Sense.IMAGE}} == {me}
    stand.server.close()
    assert threads["avatar.NAO.data.image"] == "lumen-image"


def test_a_sense_that_fails_where_time_waits_is_off_until_another_bundle() -> None:
    stand = Stand(direct=True, **without("image"))
    publish, stand.bus.publish = stand.bus.publish, failing("joint")  # type: ignore[method-assign]
    stand.live(0.2)
    assert stand.server.counts["joint"].off == "there is no joint"
    assert (stand.server.counts["joint"].published, stand.server.counts["sonar"].published) == (0, 2)
    stand.bus.publish = publish  # type: ignore[method-assign]
    stand.server.use(PROJECT)
    stand.live(0.2)
    assert stand.server.counts["joint"].off == ""
    assert stand.of("joint")
    stand.server.close()


def failing(sense: str) -> Any:
    """Return a stand-in for a robot that can't provide a sense."""

    def publish(key: str, body: dict[str, Any], **_: Any) -> None:
        if key.endswith(sense):
            raise RobotError(f"there is no {sense}")

    return publish


def test_a_camera_that_is_slow_keeps_nobody_waiting_and_the_newest_frame_wins() -> None:
    stand, inside, release = Stand(), threading.Event(), threading.Event()

    def slow() -> np.ndarray:
        inside.set()
        assert release.wait(HANG)
        return FRAME

    stand.server.sample(0.0)
    assert stand.server.settle(PATIENT)
    stand.robot.pixels = slow
    stand.robot.now = 0.1
    stand.server.sample(stand.robot.now)
    assert inside.wait(HANG)
    for i in range(6, 50):
        stand.robot.now = i * 0.02
        stand.server.sample(stand.robot.now)
        assert stand.server.settle(PATIENT)
    release.set()
    stand.server.close()
    count = stand.server.counts["image"]
    assert [body["time"] for body in stand.of("joint")][-1] > 0.9
    assert [body["time"] for body in stand.of("image")] == [0.0, 0.1, pytest.approx(0.94, abs=0.05)]
    assert (count.published, count.dropped) == (3, stand.robot.reads.count(Sense.IMAGE) - 3)


def test_the_first_image_is_waited_for_once() -> None:
    stand, inside, release = Stand(), threading.Event(), threading.Event()

    def slow() -> np.ndarray:
        inside.set()
        assert release.wait(HANG)
        return FRAME

    stand.robot.pixels = slow
    stand.server.sample(0.0)
    assert inside.wait(HANG)
    threading.Timer(0.1, release.set).start()
    assert stand.server.settle(PATIENT)
    assert stand.server.counts["image"].published == 1
    release.clear()
    stand.server.sample(0.1)
    assert stand.server._first_image is None
    assert stand.server.settle(PATIENT)
    assert stand.server.counts["image"].published == 1
    release.set()
    stand.server.close()


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
    before = threads("lumen-")
    stand.server.close()
    assert len(before - threads("lumen-")) == 5


def wrong(sense: str) -> Project:
    """Return a project whose message schema does not fit the bodies of that sense."""
    return project(messages={**PROJECT.messages, sense: {"required": ["nobody has this"]}})


@pytest.mark.parametrize("direct", [False, True])
def test_a_refused_body_costs_that_body_alone_and_a_repaired_schema_is_enough(
    caplog: pytest.LogCaptureFixture, direct: bool
) -> None:
    bus = validated(connect("memory://"), wrong("joint"))
    stand = Stand(bus=bus, direct=direct, **without("image"))
    stand.live(0.6)
    counts = stand.server.counts
    assert (counts["joint"].published, counts["joint"].refused, counts["joint"].off) == (0, 10, "")
    assert counts["sonar"].published == 6
    assert [r.getMessage() for r in caplog.records] == [
        "a reading of the sense `joint` was refused: a message on `avatar.NAO.data.joint` cannot be sent:"
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
        assert release.wait(HANG)

    stand.bus.subscribe("avatar.NAO.data.joint", slow)
    stand.server.sample(0.0)
    assert inside.wait(HANG)
    waited = waits_of(stand)
    assert not any(stand.server.settle(0.4) for _ in range(50))
    assert sum(waited) <= 0.4, "it waits once, and not each time"
    for i in range(1, 50):
        stand.server.sample(i * 0.02)
    assert len(stand.server._leaving) <= 8
    release.set()
    assert stand.server.settle(PATIENT)
    stand.server.close()


def waits_of(stand: Stand) -> list[float]:
    """Collect the times [s] that this thread asks to wait for readings on their way."""
    waited, me = list[float](), threading.current_thread()
    for handed in stand.server._leaving:

        def wait(seconds: float, usual: Callable[[float], bool] = handed.done.wait) -> bool:
            if threading.current_thread() is me:
                waited.append(seconds)
            return usual(seconds)

        handed.done.wait = wait  # type: ignore[method-assign, assignment]
    return waited


def test_a_thread_that_the_machine_holds_back_is_waited_for() -> None:
    stand, release = Stand(**without("image", "sonar", "tactile", "battery")), threading.Event()
    encode = stand.server._broadcasts[Sense.JOINT]._encode

    def held(reading: Reading) -> dict[str, Any]:
        assert release.wait(HANG)
        return encode(reading)

    stand.server._broadcasts[Sense.JOINT]._encode = held
    stand.server.sample(0.0)
    (handed,) = stand.server._leaving
    begun = handed.begun.wait

    def wait(seconds: float) -> bool:
        release.set()  # the thread runs only now, when the loop waits for its beginning
        return begun(seconds)

    handed.begun.wait = wait  # type: ignore[method-assign, assignment]
    assert stand.server.settle(PATIENT)
    assert len(stand.of("joint")) == 1
    stand.server.close()


def test_a_robot_without_a_sense_is_no_trouble() -> None:
    stand = Stand()
    stand.robot.read = lambda sense: None  # type: ignore[method-assign]
    stand.live(0.1)
    stand.server.close()
    assert stand.heard.messages == []


def test_closing_ends_the_threads_and_may_be_repeated() -> None:
    before = threads()
    stand = Stand()
    assert len(threads() - before) == 5
    stand.live(0.1)
    stand.server.close()
    stand.server.close()
    assert threads() <= before


def test_the_same_server_on_a_broker(broker: RabbitMQ) -> None:
    bus, module = connect(broker.url, PROJECT), connect(broker.url)
    senses, answers = Collector(), Collector()
    module.subscribe("avatar.NAO.data.*", senses)
    module.subscribe("lumen.me", answers)
    server = RobotServer(replace(PROJECT), Puppet(), bus)
    module.publish("avatar.NAO.command", {"Method": "rest"}, reply_to="lumen.me", correlation_id="9")
    until(lambda: server.sample(time.monotonic()) or server.answer(Event("done.command.m1")))
    answers.wait(1)
    senses.wait(5)
    server.close()
    bus.close()
    module.close()
    assert {m.key.rpartition(".")[2] for m in senses.messages} == set(Sense)
    assert [(m.body, m.correlation_id) for m in answers.messages] == [("command finished", "9")]
