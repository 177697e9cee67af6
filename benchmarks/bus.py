"""Measure the messages per second of a bus, and the time of a question, compared with pika itself in the same run.

    python benchmarks/bus.py [--bus URL] [--seconds S]

Without `--bus`, a private RabbitMQ runs on loopback. pika's BlockingConnection sends bytes that are already JSON, and
does not decode the bytes that it receives. Lumen's bus makes JSON of a body, sends it, gets the confirm, receives and
decodes it, and passes it to a handler. pika sends telemetry without confirms, as is usual. On Lumen's bus the broker
confirms every message, and the measurement ends with the last confirm.
"""

import argparse
import json
import platform
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from statistics import median, quantiles
from typing import Any, NamedTuple

sys.path.insert(0, str(Path(__file__).parents[1]))

import numpy as np
import pika

import lumen
from lumen.bus import Bus, connect
from lumen.bus.bodies import decode, encode
from lumen.bus.validated import validated
from lumen.features.rabbitmq.packing import packed, unpacked
from lumen.language.routes import FLOATS_TYPE, JPEG_TYPE, Carried, Direction, Route
from lumen.ports import Image, Joints, Sense
from lumen.robot.recording import RecordingRobot
from lumen.robot.sense_codec import encode_reading, image_body

KEY, ANSWER = "lumen.bench.body", "lumen.bench.answer"
SIZES = {"200 B": 200, "15 kB": 15_000}
ROUNDS = 5
PACE = 1_000
FILLER = "x" * 160
TELEMETRY = Route("bench", KEY, Direction.IN, keep=1_000_000)
COMMAND = Route("bench", KEY, Direction.IN, carried=Carried.COMMAND, must_arrive=True, most=10 * PACE)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--bus", help="the broker (default: a private one)")
    parser.add_argument("--seconds", type=float, default=1.0, help="how long each measurement takes")
    options = parser.parse_args()
    print(f"{platform.machine()}, {platform.system()} {platform.release()}, CPython {platform.python_version()}")
    in_process(options.seconds)
    forms(options.seconds)
    with broker(options.bus) as url:
        over_the_broker(url, options.seconds)
        round_trip(url)
        for name, kind in (("ours", Ours), ("pika", Pikas)):
            found = paced(url, kind)
            late = f"p50 {found.p50:.2f} ms, p99 {found.p99:.2f} ms"
            print(f"200 B at {PACE:,}/s, {name}  {late}, {found.spent:.0f} us of CPU")


def in_process(seconds: float) -> None:
    """Measure one publisher and one subscriber with bodies of the face detector, on the embedded bus."""
    off, on = checks(seconds)
    print(f"in process, schema checks off    {off:>9,.0f} msg/s")
    print(
        f"in process, schema checks on     {on:>9,.0f} msg/s  (checked once, {1e6 / on - 1e6 / off:.2f} us a message)"
    )


def forms(seconds: float) -> None:
    """Print sizes and processor times of an image and a joint reading as JSON and as bytes, without a bus."""
    noise = np.random.default_rng(0).normal(128.0, 20.0, (240, 320, 3)).clip(0, 255).astype(np.uint8)
    image = image_body(Image(1.5, lambda size=None: noise), 7, "2026-11-23T10:00:00.000+00:00", camera="CameraTop")
    robot = RecordingRobot(lumen.load().body)
    reading = robot.read(Sense.JOINT)
    assert isinstance(reading, Joints)
    for what, body, form in (
        ("image", image, JPEG_TYPE),
        ("joints", encode_reading(Sense.JOINT, reading), FLOATS_TYPE),
    ):
        text, bytes_ = encode(body), packed(body, form)
        assert bytes_
        headers = sum(len(key) + len(str(value)) + 7 for key, value in bytes_.headers.items())
        said = bytes_.headers
        took = [
            1e6 / best(work, seconds / 4, 100)
            for work in (
                lambda body=body: encode(body),
                lambda text=text: decode(text),
                lambda body=body, form=form: packed(body, form),
                lambda data=bytes_.data, form=form, said=said: unpacked(data, form, said),
            )
        ]
        sizes = len(text), len(bytes_.data) + headers
        for name, size, write, read in zip(("JSON", form), sizes, took[::2], took[1::2], strict=True):
            print(f"{what:6} as {name:29} {size:>7,} bytes, {write:.0f} us of CPU to write, {read:.0f} to read")


def checks(seconds: float) -> tuple[float, float]:
    """Return the messages per second within this process, unchecked and checked."""
    project, body = lumen.load(), {"x": 160, "y": 120, "time": 12.5}
    face = "lumen.visual.face.detection"
    rates = []
    for bus in (connect("memory://"), validated(connect("memory://"), project)):
        bus.subscribe(face, lambda message: None)
        rates.append(best(lambda bus=bus: bus.publish(face, body), seconds))
        bus.close()
    return rates[0], rates[1]


def best(work: Callable[[], object], seconds: float, at_once: int = 1_000) -> float:
    """Return the calls per second of CPU time, the best of several rounds."""
    rates = []
    for _ in range(ROUNDS):
        began, count = time.process_time(), 0
        while time.process_time() - began < seconds / ROUNDS:
            for _ in range(at_once):
                work()
            count += at_once
        rates.append(count / (time.process_time() - began))
    return max(rates)


def over_the_broker(url: str, seconds: float) -> None:
    """Measure sending until the last confirmation, into a queue without a reader; rounds of both sides alternate."""
    for size, length in SIZES.items():
        body = {"filler": "x" * (length - len('{"filler":""}'))}
        for what, confirms, route in (("confirmed", True, COMMAND), ("telemetry", False, TELEMETRY)):
            ours, theirs = [], []
            for _ in range(ROUNDS):
                theirs.append(raw(url, json.dumps(body).encode(), confirms, seconds / ROUNDS))
                ours.append(lumens(url, body, route, seconds / ROUNDS))
            ratio = median(mine / other for mine, other in zip(ours, theirs, strict=True))
            print(
                f"RabbitMQ, {size}, {what:9}  ours {median(ours):>8,.0f} msg/s, pika {median(theirs):>8,.0f} msg/s,"
                f" {ratio:.2f} x"
            )


def raw(url: str, body: bytes, confirms: bool, seconds: float) -> float:
    """Return the messages per second of pika's BlockingConnection."""
    connection = pika.BlockingConnection(pika.URLParameters(url))
    channel = connection.channel()
    sink(channel)
    if confirms:
        channel.confirm_delivery()
    properties = pika.BasicProperties(content_type="application/json", delivery_mode=2 if confirms else 1)
    began, count = time.perf_counter(), 0
    while time.perf_counter() - began < seconds:
        channel.basic_publish("amq.topic", KEY, body, properties, mandatory=confirms)
        count += 1
    connection.process_data_events(0)
    rate = count / (time.perf_counter() - began)
    connection.close()
    return rate


def lumens(url: str, body: Any, route: Route, seconds: float) -> float:
    """Return the messages per second of Lumen until the last is confirmed, even if that is not required.

    The publisher is at most 300 messages ahead of the sender, which is more than a camera ever is.
    """
    bus: Any = connect(url)
    bus.carry({KEY: route})
    connection = pika.BlockingConnection(pika.URLParameters(url))
    sink(connection.channel())
    sender = bus._transport.publisher
    began, count = time.perf_counter(), 0
    while time.perf_counter() - began < seconds:
        for _ in range(100):
            bus.publish(KEY, body, ttl=60.0)
        count += 100
        while len(sender.outbox) > 200:
            time.sleep(0.001)
    while sender.outbox or sender._window:
        time.sleep(0.001)
    rate = count / (time.perf_counter() - began)
    bus.close()
    connection.close()
    return rate


def sink(channel: Any) -> None:
    """Bind a queue that keeps one message, so that only the way to it is measured."""
    queue = channel.queue_declare("", exclusive=True, arguments={"x-max-length": 1}).method.queue
    channel.queue_bind(queue, "amq.topic", KEY)


def round_trip(url: str) -> None:
    """Measure commands with answers, one after another."""
    for name, asks in (("ours", asking), ("pika", asking_raw)):
        ask = asks(url)
        times = []
        for _ in range(600):
            began = time.perf_counter()
            next(ask)
            times.append(1e3 * (time.perf_counter() - began))
        cuts = quantiles(times[100:], n=100)
        print(f"round trip of a command, {name}  p50 {cuts[49]:.2f} ms, p99 {cuts[98]:.2f} ms")
        ask.close()


class Pace(NamedTuple):
    """Latencies in a steady stream [ms], median and 99th percentile, and the processor time of a message [us]."""

    p50: float
    p99: float
    spent: float


class Ours:
    """A publisher and a subscriber, each with a bus of its own in this process."""

    def __init__(self, url: str, came: Callable[[bytes], None]) -> None:
        self._sender, receiver = connect(url), connect(url)
        for bus in (self._sender, receiver):
            bus.carry({KEY: replace(TELEMETRY, most=10 * PACE)})
        self._undo = receiver.subscribe(KEY, lambda message: came(message.body["sent"]))
        self.close = lambda: (self._sender.close(), self._undo(), receiver.close())

    def send(self, sent: int) -> None:
        """Publish a message with its time of sending."""
        self._sender.publish(KEY, {"sent": sent, "filler": FILLER})


class Pikas:
    """A publisher and a subscriber with BlockingConnection, the subscriber on a thread."""

    def __init__(self, url: str, came: Callable[[int], None]) -> None:
        self._sender = pika.BlockingConnection(pika.URLParameters(url))
        self._channel = self._sender.channel()
        ready, self._ending = threading.Event(), threading.Event()

        def serve() -> None:
            connection = pika.BlockingConnection(pika.URLParameters(url))
            channel = connection.channel()
            queue = channel.queue_declare("", exclusive=True).method.queue
            channel.queue_bind(queue, "amq.topic", KEY)
            channel.basic_consume(queue, lambda *delivery: came(json.loads(delivery[3])["sent"]), auto_ack=True)
            ready.set()
            while not self._ending.is_set():
                connection.process_data_events(0.1)
            connection.close()

        self._server = threading.Thread(target=serve)
        self._server.start()
        ready.wait()

    def send(self, sent: int) -> None:
        """Publish a message with its time of sending."""
        self._channel.basic_publish("amq.topic", KEY, json.dumps({"sent": sent, "filler": FILLER}).encode())

    def close(self) -> None:
        """End the consumer, and close both connections."""
        self._ending.set()
        self._server.join()
        self._sender.close()


def paced(url: str, kind: Callable[[str, Callable[[Any], None]], "Ours | Pikas"], seconds: float = 5.0) -> Pace:
    """Send a thousand messages per second, each with its time of sending; return latencies and processor time."""
    late: list[float] = []
    ends = kind(url, lambda sent: late.append((time.perf_counter_ns() - sent) / 1e6))
    count, began, spent = round(PACE * seconds), time.perf_counter(), time.process_time()
    for number in range(count):
        time.sleep(max(0.0, began + number / PACE - time.perf_counter()))
        ends.send(time.perf_counter_ns())
    deadline = time.perf_counter() + 10.0
    while len(late) < count and time.perf_counter() < deadline:
        time.sleep(0.01)
    spent = time.process_time() - spent
    ends.close()
    if len(late) < count:
        raise RuntimeError(f"{count - len(late)} of {count} messages did not come")
    cuts = quantiles(late[PACE // 2 :], n=100)
    return Pace(cuts[49], cuts[98], 1e6 * spent / count)


def asking(url: str) -> Iterator[None]:
    """Yield after each answered command of two buses of Lumen."""
    server, client = connect(url), connect(url)
    for bus in (server, client):
        bus.carry({KEY: COMMAND})
    came = threading.Semaphore(0)
    answer: Callable[[Bus], Callable[[Any], None]] = lambda bus: lambda m: bus.reply(m, "command finished")  # noqa: E731
    undo = server.subscribe(KEY, answer(server))
    client.subscribe(ANSWER, lambda message: came.release())
    try:
        while True:
            client.publish(KEY, {"type": "motion", "method": "rest"}, reply_to=ANSWER)
            came.acquire()
            yield
    finally:
        client.close()
        undo()  # its queue would keep the messages that pika sends next
        server.close()


def asking_raw(url: str) -> Iterator[None]:
    """Yield after each answered command; both sides use BlockingConnection, the sender with confirms, as Lumen does."""
    ready, ending = threading.Event(), threading.Event()

    def serve() -> None:
        connection = pika.BlockingConnection(pika.URLParameters(url))
        channel = connection.channel()
        queue = channel.queue_declare("", exclusive=True).method.queue
        channel.queue_bind(queue, "amq.topic", KEY)

        def answer(_: Any, method: Any, properties: Any, body: bytes) -> None:
            channel.basic_publish("", properties.reply_to, b"command finished")
            channel.basic_ack(method.delivery_tag)

        channel.basic_consume(queue, answer)
        ready.set()
        while not ending.is_set():
            connection.process_data_events(0.1)
        connection.close()

    server = threading.Thread(target=serve)
    server.start()
    ready.wait()
    connection = pika.BlockingConnection(pika.URLParameters(url))
    channel = connection.channel()
    channel.confirm_delivery()
    mine, came = channel.queue_declare("", exclusive=True).method.queue, []
    channel.basic_consume(mine, lambda *delivery: came.append(delivery), auto_ack=True)
    properties = pika.BasicProperties(reply_to=mine, delivery_mode=2)
    try:
        while True:
            channel.basic_publish("amq.topic", KEY, b'{"type":"motion","method":"rest"}', properties, mandatory=True)
            while not came:
                connection.process_data_events(1.0)
            came.clear()
            yield
    finally:
        ending.set()
        server.join()
        connection.close()


@contextmanager
def broker(url: str | None) -> Iterator[str]:
    """Yield the address of the given broker, else of a private one."""
    if url:
        yield url
        return
    from tests.rabbitmq import RabbitMQ

    private = RabbitMQ()
    private.start()
    try:
        yield private.url
    finally:
        private.stop()


if __name__ == "__main__":
    main()
