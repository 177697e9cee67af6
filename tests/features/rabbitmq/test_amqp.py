"""Guarantees that only the bus on RabbitMQ gives, tested with a real broker."""

import json
import threading
from collections import Counter
from collections.abc import Iterator
from typing import Any

import pika
import pytest
from pika.heartbeat import HeartbeatChecker

from lumen.bus import Bus, BusError, Message, connect
from lumen.features.rabbitmq import amqp
from lumen.features.rabbitmq.outbox import OutgoingMessage
from tests.rabbitmq import RabbitMQ
from tests.relay import Relay
from tests.waiting import HANG, Collector, finished, threads, until

pytestmark = pytest.mark.usefixtures("patient_bus")


@pytest.fixture
def bus(broker: RabbitMQ) -> Iterator[Bus]:
    bus = connect(broker.url)
    yield bus
    bus.close()


@pytest.fixture
def stranger(broker: RabbitMQ) -> Iterator[Any]:
    """A channel of a module that uses pika itself."""
    connection = pika.BlockingConnection(pika.URLParameters(broker.url))
    yield connection.channel()
    connection.close()


@pytest.mark.parametrize(
    ("url", "says"),
    [
        ("amqp://127.0.0.1:1/", "no broker listens at 127.0.0.1:1"),
        ("amqp://guest:secret@127.0.0.1:{port}/", "refuses user `guest`"),
        ("amqp://nobody:secret@127.0.0.1:{port}/", "refuses user `nobody`"),
        ("amqp://guest:guest@127.0.0.1:{port}/nowhere", "virtual host `nowhere`"),
        ("amqp://host.invalid/", "`host.invalid` is unknown"),
        ("amqps://guest:guest@127.0.0.1:{port}/", "does not speak TLS"),
        ("amqp://guest:secret@127.0.0.1:{epmd}/", "is not an AMQP 0-9-1 broker"),
        ("amqp://guest:secret@127.0.0.1:port/", "is not the address of a broker"),
        ("amqp://", "it has no host"),
        ("amqp://h/?heartbeat=often", "is not the address of a broker"),
        ("redis://user:secret@h", "`redis://` is not a bus: write memory://"),
        ("lumen", "the address of a bus begins with"),
    ],
)
def test_a_bus_that_cant_be_reached_says_so_in_one_line(broker: RabbitMQ, url: str, says: str) -> None:
    with pytest.raises(BusError) as caught:
        connect(url.format(port=broker.port, epmd=broker.epmd))
    assert says in str(caught.value)
    assert "\n" not in str(caught.value)
    assert "secret" not in str(caught.value)


def test_a_failed_connection_leaves_no_thread(broker: RabbitMQ) -> None:
    before = threads()
    with pytest.raises(BusError):
        connect("amqp://127.0.0.1:1/")
    until(lambda: threads() <= before)


def test_closing_leaves_no_thread_and_no_queue(broker: RabbitMQ, stranger: Any) -> None:
    before = threads()
    bus = connect(broker.url)
    bus.subscribe("lumen.#", Collector())
    queue = bus._transport.consumer.subscriptions()[0].queue  # type: ignore[attr-defined]
    bus.close()
    assert threads() <= before
    with pytest.raises(pika.exceptions.ChannelClosedByBroker, match="NOT_FOUND"):
        stranger.queue_declare(queue, passive=True)


@pytest.mark.once
def test_on_the_wire_it_is_json_on_amq_topic(bus: Bus, stranger: Any) -> None:
    queue = stranger.queue_declare("", exclusive=True).method.queue
    stranger.queue_bind(queue, "amq.topic", "avatar.NAO.data.*")
    body = {"name": "Budi", "text": "selamat siang – 你好"}
    bus.publish("avatar.NAO.data.sonar", body, reply_to="lumen.me", correlation_id="7", ttl=HANG)
    bus.close()
    method, properties, data = stranger.basic_get(queue, auto_ack=True)
    assert json.loads(data.decode("utf-8")) == body
    assert "你好".encode() in data
    assert (method.routing_key, properties.content_type) == ("avatar.NAO.data.sonar", "application/json")
    assert (properties.reply_to, properties.correlation_id) == ("lumen.me", "7")
    assert 500 * HANG < int(properties.expiration) <= 1000 * HANG


@pytest.mark.once
def test_a_module_of_2015_gets_its_answer_in_its_queue_as_plain_text(bus: Bus, stranger: Any) -> None:
    bus.subscribe("avatar.NAO.command", lambda message: bus.reply(message, "command finished"))
    queue = stranger.queue_declare("", exclusive=True).method.queue
    properties = pika.BasicProperties(reply_to=queue, correlation_id="abc")
    stranger.basic_publish("amq.topic", "avatar.NAO.command", b'{"method": "rest"}', properties)
    answers: list[Any] = []
    until(lambda: answers.append(stranger.basic_get(queue, auto_ack=True)) or answers[-1][0])
    assert answers[-1][2] == b"command finished"
    assert answers[-1][1].correlation_id == "abc"


POISON = [
    b"\xff\xfe",
    b"",
    b"{",
    b"[NaN]",
    b'{"time": 1e999}',
    b"[1" + b"0" * 400 + b"]",
    b"[" * 10_000 + b"]" * 10_000,
    b'"' + b"x" * 10_000_000 + b'"',
]


def test_poison_is_dropped_with_a_warning_and_harms_nobody(
    bus: Bus, stranger: Any, caplog: pytest.LogCaptureFixture
) -> None:
    seen = Collector()
    bus.subscribe("lumen.a", seen)
    for body in POISON:
        stranger.basic_publish("amq.topic", "lumen.a", body)
    stranger.basic_publish("amq.topic", "lumen.a", b'"well"')
    assert seen.wait(1) == ["well"]
    dropped = [r.getMessage() for r in caplog.records if "was dropped" in r.getMessage()]
    assert len(dropped) == len(POISON)
    assert all("`lumen.a`" in text and len(text) < 200 for text in dropped)


def test_a_text_of_type_text_plain_is_a_text(bus: Bus, stranger: Any) -> None:
    seen = Collector()
    bus.subscribe("lumen.visual.command", seen)
    properties = pika.BasicProperties(content_type="text/plain")
    stranger.basic_publish("amq.topic", "lumen.visual.command", b"Budi", properties)
    assert seen.wait(1) == ["Budi"]


def test_a_slow_handler_costs_no_heartbeat(
    broker: RabbitMQ, caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    beats, beat = Counter[HeartbeatChecker](), HeartbeatChecker._send_heartbeat_frame

    def counted(checker: HeartbeatChecker) -> None:
        beats[checker] += 1
        beat(checker)

    monkeypatch.setattr(HeartbeatChecker, "_send_heartbeat_frame", counted)
    bus, seen, release = connect(broker.url + "?heartbeat=4"), Collector(), threading.Event()

    def slow(message: Message) -> None:
        seen(message)
        assert release.wait(HANG)

    bus.subscribe("lumen.a", slow)
    bus.publish("lumen.a", 1)
    seen.wait(1)
    beats.clear()
    until(lambda: sum(count > 2 for count in beats.values()) >= 2, what="three heartbeats on both connections")
    bus.publish("lumen.a", 2)
    release.set()
    assert seen.wait(2) == [1, 2]
    bus.close()
    assert "lost" not in caplog.text


def test_a_publisher_does_not_wait_for_a_broker_that_hears_nothing(broker: RabbitMQ, bus: Bus) -> None:
    relay, seen = Relay(broker.port), Collector()
    far = connect(f"amqp://guest:guest@{broker.place(relay.port)}")
    bus.subscribe("lumen.a", seen)
    relay.cut()
    for i in range(1000):
        far.publish("lumen.a", i)
    assert seen.bodies == []
    relay.mend()
    assert seen.wait(1000) == list(range(1000))
    far.close()
    relay.close()


def test_who_publishes_sends_unless_the_connection_is_in_use(bus: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    publisher, seen, senders = bus._transport.publisher, Collector(), dict[bytes, str]()
    send = publisher._send

    def noting(message: OutgoingMessage) -> None:
        senders[message.body] = threading.current_thread().name
        send(message)

    bus.subscribe("lumen.sent", seen)
    monkeypatch.setattr(publisher, "_send", noting)

    def sent_here() -> bool:
        bus.publish("lumen.sent", "here")
        return senders.get(b'"here"') == threading.current_thread().name

    until(sent_here)
    until(lambda: publisher.connection.lend(lambda: bus.publish("lumen.sent", "in use") or True))
    until(lambda: "in use" in seen.bodies)
    assert senders[b'"in use"'] == "lumen-bus-out"


@pytest.mark.once
def test_a_flood_arrives_whole(bus: Bus) -> None:
    seen = Collector()
    bus.subscribe("lumen.flood", seen)
    for i in range(5_000):
        bus.publish("lumen.flood", i)
    assert seen.wait(5_000) == list(range(5_000))


def test_a_key_that_may_not_be_read_is_refused_and_the_others_go_on(broker: RabbitMQ) -> None:
    bus, seen = connect(broker.url_of("visual")), Collector()
    bus.subscribe("avatar.#", seen)
    with pytest.raises(BusError, match=r"refuses the subscription to `lumen\.secret`: ACCESS_REFUSED"):
        bus.subscribe("lumen.secret", seen)
    stranger = connect(broker.url)
    stranger.publish("avatar.NAO.data.sonar", "still heard")
    assert seen.wait(1) == ["still heard"]
    stranger.close()
    bus.close()


def test_a_key_that_may_not_be_written_is_logged_and_the_others_go_on(
    broker: RabbitMQ, bus: Bus, caplog: pytest.LogCaptureFixture
) -> None:
    seen = Collector()
    bus.subscribe("#", seen)
    visual = connect(broker.url_of("visual"))
    visual.publish("avatar.NAO.command", {"method": "dance"})
    until(lambda: "ACCESS_REFUSED" in caplog.text)
    visual.publish("lumen.visual.face.detection", {"x": 1, "y": 2})
    assert seen.wait(1) == [{"x": 1, "y": 2}]
    visual.close()


def test_a_queue_that_somebody_deletes_is_made_again(bus: Bus, stranger: Any) -> None:
    seen = Collector()
    bus.subscribe("lumen.a", seen)
    bus._transport.consumer._later(lambda: bus._transport.consumer.channel.queue_delete(_subscriptions(bus)[0].queue))
    until(lambda: _subscriptions(bus)[0].epoch == 2)
    bus.publish("lumen.a", "again")
    assert seen.wait(1) == ["again"]


def _subscriptions(bus: Any) -> list[Any]:
    return list(bus._transport.consumer.subscriptions())


def test_closing_while_the_broker_is_away_ends_and_tells_what_is_unsent(
    caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(amqp, "CLOSE_TIMEOUT", 1.0)
    broker = RabbitMQ()
    broker.start()
    bus = connect(broker.url)
    broker.stop()
    links = (bus._transport.publisher, bus._transport.consumer)  # type: ignore[attr-defined]
    until(lambda: all(link.connection is None for link in links))
    bus.publish("lumen.a", "for nobody")
    closing = threading.Thread(target=bus.close, daemon=True)
    closing.start()
    finished(closing)
    assert "before 1 message could be sent" in caplog.text
