"""Reads a RabbitMQ stream from a given offset; a reader that was away misses no messages."""

from collections import deque
from contextlib import closing
from typing import Any

from pika.exceptions import ConsumerCancelled

from lumen.bus.bodies import JSON, decode
from lumen.bus.brokers import StreamEntry
from lumen.features.rabbitmq.broker import BrokerAddress
from lumen.features.rabbitmq.connection import BrokerConnection, OutageLog
from lumen.features.rabbitmq.probe import BrokerProbe
from lumen.features.rabbitmq.properties import MessageProperties

PREFETCH = 200
"""The maximum number of unacknowledged messages; a stream requires such a limit."""
MOST_READ = 2000
"""The number of messages waiting for `take` at which no more are requested."""
TURN = 0.2
"""The longest wait for events before the connection's thread checks whether to end [s]."""


class StreamReader(BrokerConnection):
    """Reads the stream `name` from the offset `first`, on a separate thread, across outages of the broker."""

    def __init__(self, url: str, name: str, first: int = 0) -> None:
        address = BrokerAddress(url)
        super().__init__(address, f"stream {name}", OutageLog(address))
        self._stream, self._next = name, first
        self._read: deque[StreamEntry] = deque()
        self._last = 0

    def take(self) -> list[StreamEntry]:
        """Return the entries read since the last call, in the stream's order."""
        return [self._read.popleft() for _ in range(len(self._read))]

    def close(self, timeout: float = 5.0) -> None:
        """Stop reading, and wait at most `timeout` [s]. A new reader can begin at the first entry not taken yet."""
        self.ending.set()
        self.join(timeout)

    def begin(self) -> None:
        """Start reading at the first unread offset."""
        self.channel.basic_qos(prefetch_count=PREFETCH)
        self.channel.add_on_cancel_callback(self._cancelled)
        self.connection.consume(self._stream, self._received, arguments={"x-stream-offset": self._next})

    def serve(self) -> bool:
        """Process events for a turn; return False after `close` is called."""
        if self._last and len(self._read) < MOST_READ:
            self.channel.basic_ack(self._last, multiple=True)
            self._last = 0
        self.process(TURN)
        return not self.ending.is_set()

    def _received(self, number: int, _: bool, name: bytes, properties: MessageProperties, data: bytes) -> None:
        self._last = number
        offset = properties.offset if properties.offset >= 0 else self._next
        if offset < self._next:  # the broker sends whole chunks, which may begin before the requested offset
            return
        self._next = offset + 1
        key = name.decode(errors="ignore")
        try:
            body = decode(data, properties.content_type or JSON, properties.content_encoding)
        except ValueError:
            body = None
        self._read.append(StreamEntry(offset, key, body, properties.message_id, float(properties.timestamp)))

    def _cancelled(self, frame: Any) -> None:
        self.connection.fail(ConsumerCancelled(frame.method.consumer_tag))


def read_stream(url: str, name: str, first: int) -> StreamReader | None:
    """Return an open reader of a stream from the offset `first`; None if the broker has no queue `name`.

    Raises BusError, with the remedy, if the broker is unusable.
    """
    with closing(BrokerProbe(url)) as probe:
        if not probe.has_queue(name):
            return None
    reader = StreamReader(url, name, first)
    reader.open()
    return reader
