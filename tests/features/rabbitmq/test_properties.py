"""A message may have any AMQP properties: the bus accepts it and keeps its connection."""

import logging
import struct
import time
from collections.abc import Iterator
from random import Random

import pika
import pytest

from lumen.bus import connect
from lumen.features.rabbitmq.outbox import OutgoingMessage
from lumen.features.rabbitmq.polled import PolledConnection
from lumen.features.rabbitmq.properties import MessageProperties, header_fields, read_properties
from lumen.features.rabbitmq.publisher import Publisher
from tests.attack.messages import PROPERTIES, HostileMessage, Stranger, encoded, header, nested
from tests.rabbitmq import RabbitMQ
from tests.waiting import Collector, until

pytestmark = pytest.mark.usefixtures("patient_bus")

FAR = struct.pack(">Q", 2**63)
POISON = {
    "no UTF-8": encoded(content_type=b"\xff", reply_to=b"\xff\xfe", correlation_id=b"\x80", message_id=b"\xc0"),
    "a type": encoded(type=b"\xff"),
    "a date": encoded(timestamp=2**63, headers=header(b"at", b"T", FAR)),
    "tables": encoded(headers=nested(3_000)),
    "a decimal": encoded(headers=header(b"\xff", b"D", b"\xff\x7f\xff\xff\xff")),
}


@pytest.fixture
def stranger(broker: RabbitMQ) -> Iterator[Stranger]:
    one = Stranger(broker.url)
    yield one
    one.close()


def test_properties_are_read_as_pika_reads_them() -> None:
    given = pika.BasicProperties(
        content_type="text/plain", content_encoding="utf-8", headers={"a": {"b": [1, None]}}, delivery_mode=2,
        priority=3, correlation_id="c", reply_to="lumen.a", expiration="5", message_id="m", timestamp=7, type="t",
        user_id="u", app_id="a", cluster_id="x",
    )  # fmt: skip
    read = read_properties(b"".join(given.encode()))
    expected = MessageProperties("text/plain", "c", "lumen.a", "m", "t", 7, "a", 2, content_encoding="utf-8")
    assert read._replace(table=b"") == expected
    assert read_properties(b"".join(pika.BasicProperties(timestamp=7).encode())).timestamp == 7


def test_other_headers_are_read_by_who_asks_as_far_as_they_can_be() -> None:
    said = {"a": "text", "b": [1], "width": 320, "big": 2**40, "yes": True, "none": None, "odd": {"a": 1}}
    table = read_properties(b"".join(pika.BasicProperties(headers=said).encode())).table
    assert header_fields(table) == {"a": "text", "width": 320, "big": 2**40, "yes": True}
    assert header_fields(table[:14]) == {"a": "text"}
    assert header_fields(b"\xff\xff") == {}


def test_of_the_headers_the_cause_is_read_where_texts_stand_before_it() -> None:
    def read(headers: dict[str, object]) -> str:
        return read_properties(b"".join(pika.BasicProperties(headers=headers).encode())).headers

    assert read({"cause": "d3"}) == read({"reason": "x", "cause": "d3"}) == "d3"
    assert read({}) == read({"cause": 3}) == read({"deep": {"cause": "d3"}, "cause": "d3"}) == ""


def test_where_a_message_stands_in_a_stream_is_read_behind_whatever_a_sender_invents() -> None:
    def read(*entries: bytes) -> int:
        return read_properties(encoded(headers=b"".join(entries))).offset

    offset = header(b"x-stream-offset", b"l", struct.pack(">q", 2**40))
    text = header(b"a", b"S", struct.pack(">I", len(offset)) + offset)
    table = header(b"b", b"F", struct.pack(">I", len(offset)) + offset)
    assert read(offset) == read(text, table, offset) == 2**40
    assert read(text) == read(table) == read(header(b"x-stream-offset", b"S", b"\0\0\0\1x")) == -1
    assert read(offset[:-1]) == read(header(b"x", b"?", b""), offset) == -1


def test_no_bytes_are_too_many_or_too_few() -> None:
    random = Random(1)
    for make in (*PROPERTIES, lambda random: random.randbytes(random.randrange(40))):
        for _ in range(200):
            data = make(random)
            read_properties(data)
            read_properties(data[: random.randrange(len(data) + 1)])
    assert read_properties(encoded(reply_to=b"\xff", type=b"t")) == MessageProperties(
        type="t", unreadable=("reply_to",)
    )


def test_no_property_ends_the_connection_nor_the_thread_that_handles(
    broker: RabbitMQ, stranger: Stranger, caplog: pytest.LogCaptureFixture
) -> None:
    bus, seen = connect(broker.url), Collector()
    connection = bus._transport.consumer.connection  # type: ignore[attr-defined]
    bus.subscribe("lumen.poison.#", seen)
    with caplog.at_level(logging.WARNING):
        for i, properties in enumerate(POISON.values()):
            stranger.send(HostileMessage("lumen.poison.a", str(i).encode(), properties))
        stranger.send(HostileMessage(b"lumen.poison.\xff", b'"key"', encoded()))
        stranger.send(HostileMessage("lumen.poison.a", b'"last"', encoded()))
        assert seen.wait(7) == [0, 1, 2, 3, 4, "key", "last"]
    assert bus._transport.consumer.connection is connection  # type: ignore[attr-defined]
    assert seen.messages[5].key == "lumen.poison.\\xff"
    told = [record.getMessage() for record in caplog.records]
    assert told == [
        "properties of messages on `lumen.poison.a` are dropped: content_type, correlation_id, reply_to, message_id "
        "cannot be read; the message is accepted without it"
    ]
    bus.close()
    assert bus._transport.consumer.unreadable.counts == {"lumen.poison.a": 2}  # type: ignore[attr-defined]


def test_an_answer_that_amqp_cant_carry_costs_that_answer(broker: RabbitMQ, caplog: pytest.LogCaptureFixture) -> None:
    bus, seen = connect(broker.url), Collector()
    bus.subscribe("lumen.carried", seen)
    publisher: Publisher = bus._transport.publisher  # type: ignore[attr-defined]
    publisher.outbox.put(OutgoingMessage("amq.topic", "lumen.carried", b"0", "x" * 300))
    bus.publish("lumen.carried", 1)
    assert seen.wait(1) == [1]
    until(lambda: publisher.unsendable.counts)
    assert "messages on `lumen.carried` are dropped: AMQP cannot carry it" in caplog.text
    bus.close()


def test_a_connection_with_nothing_to_say_sleeps(broker: RabbitMQ) -> None:
    """A turn of the loop that ends early leaves no timer behind, which would end another turn."""
    connection = PolledConnection(pika.URLParameters(broker.url))
    connection.open_channel()
    for _ in range(100):
        connection.wake()
        connection.turn(0.25)
    turns, until = 0, time.monotonic() + 0.75
    while time.monotonic() < until:
        connection.turn(0.25)
        turns += 1
    connection.close()
    assert turns < 10
