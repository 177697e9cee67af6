"""Messages as we write and read them are those of pika, however the bytes are cut."""

from collections.abc import Mapping
from random import Random
from typing import Any

import pika
import pytest
from pika import frame, spec
from pika.adapters.select_connection import IOLoop
from pika.exceptions import InvalidFrameError

from lumen.features.rabbitmq.properties import MessageProperties, read_properties, write_properties
from lumen.features.rabbitmq.wire import WireConnection
from tests.tables import for_each

PIECE = 50
"""The size of a frame's part of a body in these tests [bytes]."""
READER = b"ctag1"

Seen = tuple[int, bool, bytes, MessageProperties, bytes]


class Wire(WireConnection):
    """A connection without a broker; `rest` collects the frames that pika handles itself."""

    is_open = True

    def __init__(self) -> None:
        self.had: list[tuple[int, bool]] = []
        self.dropped: list[int] = []
        super().__init__(
            pika.ConnectionParameters(),
            custom_ioloop=IOLoop(),
            internal_connection_workflow=False,
            unread=self.dropped.append,
            confirmed=lambda number, several: self.had.append((number, several)),
        )
        self._body_max_length = PIECE
        self.rest: list[Any] = []
        self.seen: list[Seen] = []
        self.readers[READER] = lambda *message: self.seen.append(message)

    @property
    def written(self) -> bytes:
        return b"".join(self._frames)

    def hear(self, data: bytes) -> None:
        self._on_data_available(data)

    def _process_frame(self, value: Any) -> None:
        self.rest.append(value)


def properties(draw: Random) -> Mapping[str, Any]:
    texts = ("content_type", "content_encoding", "reply_to", "correlation_id", "expiration", "type", "message_id")
    said: dict[str, Any] = {name: draw.choice(("", "a", "ä" * 100)) for name in (*texts, "app_id")}
    headers = {"cause": "step 7", "number": draw.randrange(-(2**40), 2**40)}
    return {
        **said,
        "headers": draw.choice(({}, headers)),
        "delivery_mode": draw.choice((0, 2)),
        "timestamp": draw.choice((0, 2**33)),
    }


def marshalled(channel: int, method: Any, said: Mapping[str, Any], body: bytes) -> bytes:
    """Return a message as pika writes it."""
    given = pika.BasicProperties(**{name: value or None for name, value in said.items()})
    pieces = [frame.Body(channel, body[at : at + PIECE]) for at in range(0, len(body), PIECE)]
    frames = frame.Method(channel, method), frame.Header(channel, len(body), given), *pieces
    return b"".join(one.marshal() for one in frames)


@pytest.mark.network
def test_a_message_is_written_as_pika_writes_it() -> None:
    draw = Random(98)
    for _ in range(100):
        said, body = properties(draw), draw.randbytes(draw.choice((0, 1, PIECE, 3 * PIECE + 1)))
        channel, key, mandatory = draw.randrange(1, 2**16), "lumen.ü" * draw.randrange(20), draw.random() < 0.5
        wire = Wire()
        wire.send(channel, "amq.topic", key, write_properties(said), body, mandatory=mandatory)
        method = spec.Basic.Publish(exchange="amq.topic", routing_key=key, mandatory=mandatory)
        assert wire.written == marshalled(channel, method, said, body)


@pytest.mark.network
@pytest.mark.parametrize(("text", "why"), [("x" * 256, "range"), ("\ud800", "surrogates")])
def test_what_is_no_short_text_is_refused_before_anything_is_written(text: str, why: str) -> None:
    wire = Wire()
    with pytest.raises(ValueError, match=why):
        wire.send(1, "amq.topic", text, b"\0\0", b"", mandatory=False)
    with pytest.raises(ValueError, match=why):
        write_properties({"content_type": text})
    assert not wire.written


class Line:
    """A stand-in for the socket, which fails or accepts a few bytes at once, and for pika's own buffer."""

    def __init__(self, takes: int | OSError) -> None:
        self._sock, self._takes = self, takes
        self.at_once, self.later = b"", b""

    def get_write_buffer_size(self) -> int:
        return len(self.later)

    def send(self, data: bytes) -> int:
        if isinstance(self._takes, OSError):
            raise self._takes
        self.at_once += data[: self._takes]
        return min(self._takes, len(data))

    def write(self, data: bytes) -> None:
        self.later += data


class OpenWire(WireConnection):
    """A connection that writes to a `Line`."""

    is_closed = False

    def __init__(self, line: Line) -> None:
        self._transport, self._plain, self._frames, self._size = line, True, [], 0
        self.bytes_sent = 0


@for_each(
    ("takes", "at_once"),
    [(BlockingIOError(), b""), (BrokenPipeError(), b""), (3, b"ab1"), (6, b"ab12cd"), (100, b"ab12cd")],
)
def test_what_the_system_does_not_take_at_once_is_left_to_pika(takes: int | OSError, at_once: bytes) -> None:
    line = Line(takes)
    wire = OpenWire(line)
    for piece in (b"ab", b"12", b"cd"):
        wire._adapter_emit_data(piece)
    wire.flush()
    assert line.at_once == at_once
    assert line.at_once + line.later == b"ab12cd"
    wire.flush()
    wire._adapter_emit_data(b"ef")
    wire.flush()
    assert line.at_once + line.later == b"ab12cdef", "what waits for room is sent first"


@pytest.mark.network
def test_what_comes_is_read_wherever_it_is_cut() -> None:
    draw, wire = Random(98), Wire()
    sent, had, rest, data = list[Seen](), list[tuple[int, bool]](), list[str](), b""
    for number in range(1, 120):
        kind = draw.choice(("message", "message", "confirm", "other"))
        if kind == "message":
            said, body, again = properties(draw), draw.randbytes(draw.randrange(4 * PIECE)), draw.random() < 0.5
            method = spec.Basic.Deliver(READER.decode(), number, again, "amq.topic", f"lumen.{number}")
            whole = marshalled(1, method, said, body)
            sent.append((number, again, b"lumen.%d" % number, read_properties(write_properties(said)), body))
            if draw.random() < 0.3:  # what concerns another channel comes in between
                other = frame.Method(2, spec.Queue.BindOk()).marshal()
                end = len(frame.Method(1, method).marshal())
                whole = whole[:end] + other + whole[end:]
                rest.append("Method")
            data += whole
        elif kind == "confirm":
            several = draw.random() < 0.5
            had.append((number, several))
            data += frame.Method(1, spec.Basic.Ack(number, several)).marshal()
        else:
            rest.append("Heartbeat")
            data += frame.Heartbeat().marshal()
    at = 0
    while at < len(data):
        size = draw.choice((1, 7, 8, 30, 400))
        wire.hear(data[at : at + size])
        at += size
    assert (wire.seen, wire.had) == (sent, had)
    assert [type(value).__name__ for value in wire.rest] == rest
    assert wire.bytes_received == len(data), "by which pika knows that the broker lives"


@pytest.mark.network
def test_a_message_that_nobody_takes_goes_back() -> None:
    wire = Wire()
    wire.hear(marshalled(1, spec.Basic.Deliver("ctag2", 7, False, "amq.topic", "lumen.a"), {}, b"body"))
    assert (wire.seen, wire.dropped) == ([], [7])


@pytest.mark.network
def test_a_frame_without_its_end_is_no_frame() -> None:
    data = frame.Method(1, spec.Basic.Ack(1)).marshal()
    with pytest.raises(InvalidFrameError):
        Wire().hear(data[:-1] + b"\0")
