"""Messages that must arrive do so exactly once despite faults of broker and network; memory stays bounded."""

import logging
import threading
import time
import tracemalloc
from collections import Counter
from collections.abc import Iterator
from typing import Any

import pika
import pytest

from lumen.bus import Bus, Message, connect
from lumen.language.routes import Carried, Direction, Route
from tests.rabbitmq import RabbitMQ
from tests.relay import Relay
from tests.waiting import HANG, Collector, until

pytestmark = pytest.mark.usefixtures("patient_bus")

WAYS = {
    "lumen.fault.command": Route(
        "command", "lumen.fault.command", Direction.IN, carried=Carried.COMMAND, must_arrive=True, ttl=600.0, most=1e6
    ),
    "lumen.fault.journal": Route(
        "journal", "lumen.fault.journal", Direction.IN, carried=Carried.JOURNAL, must_arrive=True
    ),
}
MEGABYTE = 2**20


def opened(url: str) -> Bus:
    bus = connect(url)
    bus.carry(WAYS)
    return bus


@pytest.fixture
def no_thread_stays() -> Iterator[None]:
    before = set(threading.enumerate())
    yield
    until(lambda: not [t for t in set(threading.enumerate()) - before if t.name.startswith("lumen-bus")])


MANY = 5_000
"""The number of waiting messages at which tests send no more: the bus refuses the 10,001st."""


class Sending:
    """Publishes numbers under both keys, at a pace, until it is told to end; `sent` is how many under each."""

    def __init__(self, bus: Bus, pause: float) -> None:
        self.sent, self._bus, self._pause = 0, bus, pause
        self._ending = threading.Event()
        self._thread = threading.Thread(target=self._run)
        self._thread.start()

    def end(self) -> int:
        self._ending.set()
        self._thread.join()
        return self.sent

    def _run(self) -> None:
        outbox = self._bus._transport.publisher.outbox  # type: ignore[attr-defined]
        while not self._ending.wait(self._pause):
            if len(outbox) > MANY:  # the broker is away for long
                continue
            for key in WAYS:
                self._bus.publish(key, self.sent)
            self.sent += 1


class Effects(Counter[tuple[str, int]]):
    """Counts the effects of each message."""

    def __call__(self, message: Message) -> None:
        self[message.key, message.body] += 1


def arrive_once(effects: Effects, sent: int, timeout: float = HANG) -> None:
    wanted = {(key, n): 1 for key in WAYS for n in range(sent)}
    until(lambda: len(effects) >= len(wanted), timeout)
    assert dict(effects) == wanted


@pytest.mark.usefixtures("no_thread_stays")
def test_a_broker_that_is_killed_and_started_again_loses_and_doubles_nothing(caplog: pytest.LogCaptureFixture) -> None:
    broker = RabbitMQ()
    broker.start()
    try:
        with caplog.at_level(logging.WARNING):
            live_through_a_power_cut(broker)
    finally:
        broker.stop()
    said = [record.getMessage() for record in caplog.records]
    assert not any("does not confirm the subscription" in text for text in said)
    assert sum(" is lost: " in text for text in said) == 2
    assert sum(text.startswith("the broker") and text.endswith("is back") for text in said) == 2, (
        "once for each of the two buses, whatever they are made of"
    )


def live_through_a_power_cut(broker: RabbitMQ) -> None:
    reader, sender, effects, later = opened(broker.url), opened(broker.url), Effects(), Collector()
    for key in WAYS:
        reader.subscribe(key, effects)
    sending = Sending(sender, 0.01)
    until(lambda: len(effects) > 100)
    broker.kill()
    links = [link for bus in (reader, sender) for link in links_of(bus)]
    until(lambda: all(link.connection is None for link in links))
    assert reader.away, "who tells people of it asks this"
    reader.subscribe("lumen.fault.later", later)  # waiting for the broker would log a warning: see the test's end
    sender.publish("lumen.fault.later", "stale", ttl=0.001)
    sent = sending.sent
    until(lambda: sending.sent > sent + 50)
    broker.start()
    sent = sending.sent
    until(lambda: len(effects) > 2 * sent)
    arrive_once(effects, sending.end())
    until(lambda: all(link.connection for link in links) and not reader.away)
    sender.publish("lumen.fault.later", "bound since")
    assert later.wait(1) == ["bound since"]
    sender.close()
    reader.close()


@pytest.mark.soak
@pytest.mark.usefixtures("no_thread_stays")
def test_a_broker_that_is_killed_while_a_journal_is_made_makes_it_anew() -> None:
    broker, key, seen = RabbitMQ(), "lumen.fault.journal", Collector()
    broker.start()
    try:
        reader, sender = opened(broker.url), opened(broker.url)
        consumer = reader._transport.consumer  # type: ignore[attr-defined]
        subscribing = threading.Thread(target=reader.subscribe, args=(key, seen))
        subscribing.start()
        until(lambda: consumer._declarer.settling)
        broker.kill()
        broker.start()
        until(lambda: any(s.tag for s in consumer.subscriptions() if s.pattern == key))
        for n in range(3):
            sender.publish(key, n)
        assert seen.wait(3) == [0, 1, 2]
        subscribing.join()
        sender.close()
        reader.close()
    finally:
        broker.stop()


def links_of(bus: Any) -> list[Any]:
    return [bus._transport.publisher, bus._transport.consumer]


def cut_for(seconds: float, broker: RabbitMQ) -> None:
    """Cut the network for a while without closing a connection; every message must arrive once."""
    relay, effects = Relay(broker.port), Effects()
    url = f"amqp://guest:guest@{broker.place(relay.port)}?heartbeat=1"
    reader, sender = opened(url), opened(url)
    for key in WAYS:
        reader.subscribe(key, effects)
    sending = Sending(sender, 0.01)
    until(lambda: len(effects) > 20)
    relay.cut()
    passed = time.monotonic() + seconds
    until(lambda: time.monotonic() > passed)
    relay.mend()
    came = len(effects)
    until(lambda: len(effects) > came + 50)
    arrive_once(effects, sending.end())
    sender.close()
    reader.close()
    relay.close()


@pytest.mark.usefixtures("no_thread_stays")
def test_a_network_that_is_cut_loses_and_doubles_nothing(broker: RabbitMQ) -> None:
    cut_for(3.0, broker)


@pytest.mark.soak
@pytest.mark.usefixtures("no_thread_stays")
def test_a_network_that_is_cut_for_ten_seconds_loses_and_doubles_nothing(broker: RabbitMQ) -> None:
    cut_for(10.0, broker)


def flood(broker: RabbitMQ, count: int, pause: float) -> float:
    """Send `count` messages of 200 bytes under each key to a slow reader; return the most memory in use [bytes]."""
    effects, filler = Effects(), "x" * 180

    def slow(message: Message) -> None:
        effects[message.key, message.body["n"]] += 1
        if pause:
            threading.Event().wait(pause)

    reader, sender = opened(broker.url), opened(broker.url)
    for key in WAYS:
        reader.subscribe(key, slow)
    tracemalloc.start()
    for n in range(count):
        for key in WAYS:
            until(lambda: len(sender._transport.publisher.outbox) <= MANY)  # type: ignore[attr-defined]
            sender.publish(key, {"n": n, "filler": filler})
    arrive_once(effects, count, 600)
    most = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    sender.close()
    reader.close()
    return most


@pytest.mark.usefixtures("no_thread_stays")
def test_a_flood_on_a_slow_reader_arrives_whole_and_fills_no_memory(broker: RabbitMQ) -> None:
    assert flood(broker, 1_000, 0.0002) < 30 * MEGABYTE


@pytest.mark.soak
@pytest.mark.usefixtures("no_thread_stays")
def test_a_flood_of_fifty_thousand_arrives_whole_and_fills_no_memory(broker: RabbitMQ) -> None:
    assert flood(broker, 50_000, 0.0002) < 60 * MEGABYTE


@pytest.mark.usefixtures("no_thread_stays")
def test_telemetry_that_nobody_can_take_fills_no_memory(broker: RabbitMQ) -> None:
    """A camera publishes while the network is away: only the newest frame waits."""
    relay, key = Relay(broker.port), "lumen.fault.image"
    bus, seen = connect(f"amqp://guest:guest@{broker.place(relay.port)}"), Collector()
    bus.carry({key: Route("image", key, Direction.OUT, keep=1)})
    relay.cut()
    tracemalloc.start()
    for n in range(2_000):
        bus.publish(key, {"n": n, "frame": f"{n:15000}"})
    most = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert most < 20 * MEGABYTE
    reader = connect(broker.url)
    reader.subscribe(key, seen)
    relay.mend()
    until(lambda: seen.bodies and seen.bodies[-1]["n"] == 1_999)
    for one in (bus, reader):
        one.close()
    relay.close()


POISON = [b"\xff\xfe", b"{", b"[" * 10_000 + b"]" * 10_000, b'"' + b"x" * 10_000_000 + b'"', b"[NaN]"]


@pytest.mark.usefixtures("no_thread_stays")
def test_poison_on_a_way_that_must_arrive_is_put_aside_and_holds_up_nobody(broker: RabbitMQ) -> None:
    connection = pika.BlockingConnection(pika.URLParameters(broker.url))
    channel, seen = connection.channel(), Collector()
    bus = opened(broker.url)
    dead = channel.queue_declare("", exclusive=True).method.queue
    channel.queue_bind(dead, "lumen.dead")
    bus.subscribe("lumen.fault.journal", seen)
    for body in POISON:
        channel.basic_publish("amq.topic", "lumen.fault.journal", body)
    channel.basic_publish("amq.topic", "lumen.fault.journal", b'"well"')
    assert seen.wait(1) == ["well"]
    until(lambda: channel.queue_declare(dead, passive=True).method.message_count == len(POISON))
    for body in POISON:
        _, properties, kept = channel.basic_get(dead, auto_ack=True)
        assert kept == body[: 2**20]
        assert properties.headers["key"] == "lumen.fault.journal"
        assert properties.headers["reason"]
    bus.close()
    connection.close()
