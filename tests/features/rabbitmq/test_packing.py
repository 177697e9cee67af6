"""Images and joints as bytes on a broker: what a program with pika alone receives, how often, and what Lumen does."""

import base64
import struct
import threading
from collections.abc import Iterator
from dataclasses import replace
from io import BytesIO
from typing import Any

import numpy as np
import pika
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image as Picture

import lumen
from lumen.bus import connect
from lumen.bus.validated import validated
from lumen.features.rabbitmq import publisher
from lumen.features.rabbitmq.packing import packed, unpacked
from lumen.language.projects import Project
from lumen.language.routes import FLOATS_TYPE, JPEG_TYPE, Direction, Route
from lumen.ports import Image, Reading, Sense
from lumen.robot.recording import RecordingRobot
from lumen.robot.sense_codec import encode_reading, image_body
from lumen.robot.server import RobotServer
from lumen.run.setup import set_up
from tests.rabbitmq import RabbitMQ
from tests.tables import for_each
from tests.waiting import HANG, Collector, until

IMAGES, SLOW, PACKED = "avatar.Pia.data.image", "avatar.Pia.data.image.slow", "avatar.Pia.data.joint.packed"
FRAMES = 30
"""The frames of a second."""


def picture(shade: int = 0) -> Image:
    return Image(1.5, lambda size=None: np.full((240, 320, 3), shade, np.uint8))


class Seeing(RecordingRobot):
    """A robot with a camera; `drawn` counts the pictures that it drew on request."""

    drawn = 0

    def read(self, sense: Sense) -> Reading | None:
        if sense is not Sense.IMAGE:
            return super().read(sense)

        def pixels(size: Any = None) -> Any:
            self.drawn += 1
            return np.zeros((240, 320, 3), np.uint8)

        return Image(self.time, pixels)


class Plain:
    """A program that uses pika alone, and receives messages under keys until closed."""

    def __init__(self, url: str, *keys: str) -> None:
        self.came: list[tuple[str, Any, bytes]] = []
        self._url, self._keys, self._bound = url, keys, threading.Event()
        self._thread = threading.Thread(target=self._run)
        self._thread.start()
        assert self._bound.wait(HANG)

    def of(self, key: str) -> list[tuple[str, Any, bytes]]:
        return [one for one in self.came if one[0] == key]

    def close(self) -> None:
        self.connection.add_callback_threadsafe(self.channel.stop_consuming)
        self._thread.join(HANG)

    def _run(self) -> None:
        self.connection = pika.BlockingConnection(pika.URLParameters(self._url))
        self.channel = self.connection.channel()
        queue = self.channel.queue_declare("", exclusive=True).method.queue
        for key in self._keys:
            self.channel.queue_bind(queue, "amq.topic", key)
        self.channel.basic_consume(
            queue, lambda _, method, said, body: self.came.append((method.routing_key, said, body)), auto_ack=True
        )
        self._bound.set()
        self.channel.start_consuming()
        self.connection.close()


@pytest.fixture(scope="module")
def project() -> Project:
    routes = (
        Route("image", IMAGES, Direction.OUT, "image", every=1 / FRAMES, keep=1),
        Route("slow", SLOW, Direction.OUT, "image", every=0.5, keep=1, of="image", content_type=JPEG_TYPE),
        Route("packed", PACKED, Direction.OUT, "joint", every=0.1, of="joint", content_type=FLOATS_TYPE),
    )
    return replace(lumen.load(), robot="Pia", routes={route.name: route for route in routes})


@pytest.fixture
def plain(broker: RabbitMQ) -> Iterator[Plain]:
    one = Plain(broker.url, SLOW, PACKED)
    yield one
    one.close()


def test_a_consumer_that_wants_two_images_a_second_gets_two(
    project: Project, broker: RabbitMQ, plain: Plain, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The other route, at thirty images a second, has no consumer: only its first image, a probe, is drawn."""
    monkeypatch.setattr(publisher, "PROBE_PERIOD", 3_600.0)
    bus, ear, told = validated(connect(broker.url), project), connect(broker.url), Collector()
    ear.subscribe(SLOW, told)
    robot = Seeing(project.body)
    server = RobotServer(project, robot, bus)
    try:
        server.sample(0.0)
        until(lambda: not bus.heard(IMAGES))
        for tick in range(1, 10 * 50):
            robot.advance(0.02)
            server.sample(tick / 50)
            if tick % 25 == 0:
                until(lambda count=tick // 25 + 1: server.counts["slow"].published == len(plain.of(SLOW)) == count)
        until(lambda: len(plain.of(SLOW)) == 20)
        assert (server.counts["image"].published, robot.drawn) == (1, 21), "one was to find out that nobody wants them"
        _, said, body = plain.of(SLOW)[1]
        assert (said.content_type, said.content_encoding) == (JPEG_TYPE, None)
        assert Picture.open(BytesIO(body)).size == (said.headers["width"], said.headers["height"]) == (320, 240)
        assert (float(said.headers["time"]), said.headers["camera"]) == (pytest.approx(0.52, abs=0.05), "CameraTop")
        assert told.wait(20)[1]["contentUrl"] == "data:image/jpeg;base64," + base64.b64encode(body).decode()
    finally:
        server.close()
        bus.close()
        ear.close()


def test_joints_are_numbers_of_32_bits_in_the_order_of_names(project: Project, broker: RabbitMQ, plain: Plain) -> None:
    bus, ear, told = validated(connect(broker.url), project), connect(broker.url), Collector()
    ear.subscribe(PACKED, told)
    robot = set_up("recording", project, "max").robot
    server = RobotServer(project, robot, bus)
    try:
        server.sample(0.0)
        until(lambda: plain.of(PACKED))
        _, said, body = plain.of(PACKED)[0]
        names, lists = (said.headers[key].split(",") for key in ("names", "lists"))
        numbers = struct.unpack(f"<{len(names) * len(lists)}f", body)
        reading: Any = robot.read(Sense.JOINT)
        assert names == list(reading.names)
        assert numbers[: len(names)] == pytest.approx(reading.angles)
        [heard] = told.wait(1)
        assert heard["angle"] == list(numbers[: len(names)])
        assert heard.keys() == encode_reading(Sense.JOINT, reading).keys()
    finally:
        server.close()
        bus.close()
        ear.close()


NAMES = st.text(st.characters(exclude_characters=",", codec="utf-8"))
NUMBERS = st.floats(width=32, allow_nan=False, allow_infinity=False)


@given(
    rows=st.lists(st.tuples(NAMES, NUMBERS, NUMBERS), min_size=1),
    time=NUMBERS,
    more=st.dictionaries(st.sampled_from(["inertial", "fsr", "life"]), st.dictionaries(st.text("abc"), NUMBERS)),
)
def test_joints_come_out_as_they_went_in(rows: list[Any], time: float, more: dict[str, Any]) -> None:
    names, angles, stiffness = (list(column) for column in zip(*rows, strict=True))
    body = {"name": names, "angle": angles, "stiffness": stiffness, "time": time, **more}
    form = packed(body, FLOATS_TYPE)
    assert form
    assert unpacked(form.data, FLOATS_TYPE, form.headers) == body


def test_an_image_comes_out_as_it_went_in() -> None:
    body = image_body(picture(), 7, "2026-11-23T10:00:00.000+00:00", camera="CameraTop")
    form = packed(body, JPEG_TYPE)
    assert form
    assert len(form.data) == body["contentSize"]
    assert unpacked(form.data, JPEG_TYPE, form.headers) == body
    assert packed({**body, "odd": [1]}, JPEG_TYPE) is None, "what has no place in a header goes as JSON"


@for_each(
    ("data", "form", "headers"),
    [
        (b"GIF89a", JPEG_TYPE, {}),
        (b"\0\0\0\0", FLOATS_TYPE, {}),
        (b"\0\0\0\0", FLOATS_TYPE, {"names": "A", "lists": "angle,stiffness"}),
        (b"\0\0\0\0", FLOATS_TYPE, {"names": "A", "lists": "angel"}),
        (b"\0\0\xc0\x7f", FLOATS_TYPE, {"names": "A", "lists": "angle"}),
        (b"\0\0\0\0", FLOATS_TYPE, {"names": "A", "lists": "angle", "more": "["}),
    ],
)
def test_what_is_none_of_these_is_dropped_with_a_reason(data: bytes, form: str, headers: dict[str, Any]) -> None:
    with pytest.raises(ValueError, match=r"it is not a|do not match|JSON has no number|must be a"):
        unpacked(data, form, headers)
