"""pika's connection with faster writing and reading of messages.

Nearly all traffic consists of three methods: publish, deliver and acknowledge. pika makes objects of their frames and
looks up a handler for each frame, which takes most of a message's time; here the frames stay bytes. pika handles
everything else: login, channels, heartbeats, requests and answers.
"""

from collections.abc import Callable
from socket import socket
from struct import pack, unpack_from
from typing import Any

from pika import spec
from pika.exceptions import AMQPConnectionError

from lumen.features.rabbitmq.properties import MessageProperties, TolerantConnection, read_properties, short_text

FLUSH_BYTES = 8 * 1024
"""The size above which buffered frames are sent immediately [bytes]; fewer bytes wait for the next turn."""
READ_BYTES = 64 * 1024
"""The most bytes read per turn, in one system call; pika would read until nothing is left."""

MessageReader = Callable[[int, bool, bytes, MessageProperties, bytes], None]
"""A function that receives a message's number, whether it may be a repetition, its key, its properties and its body."""

_HEAD = spec.FRAME_HEADER_SIZE
_DELIVER, _ACK = (pack(">I", method.INDEX) for method in (spec.Basic.Deliver, spec.Basic.Ack))
_PUBLISH = pack(">IH", spec.Basic.Publish.INDEX, 0)
_END = bytes([spec.FRAME_END])


class _Coming:
    """A partly received message."""

    def __init__(self, method: bytes) -> None:
        self.consumer, at = _short(method, 4)
        self.number, again = unpack_from(">QB", method, at)
        self.again = bool(again)
        _, at = _short(method, at + 9)
        self.key, _ = _short(method, at)
        self.properties = MessageProperties()
        self.missing = 0
        self.parts: list[bytes] = []


class WireConnection(TolerantConnection):
    """A connection whose frames are buffered and sent together by `flush`.

    `readers` maps each consumer's tag to the function for its messages. `unread` is called with the number of a message
    without a reader. `confirmed` is called with the number of a message that the broker has confirmed, and whether that
    includes all earlier messages.
    """

    _frame_buffer: bytes

    def __init__(
        self, *args: Any, unread: Callable[[int], None], confirmed: Callable[[int, bool], object], **kwargs: Any
    ) -> None:
        self.readers: dict[bytes, MessageReader] = {}
        self._unread, self._confirmed = unread, confirmed
        self._coming: _Coming | None = None
        self._frames: list[bytes] = []
        self._size = 0
        self._plain = False
        super().__init__(*args, **kwargs)

    def send(self, channel: int, exchange: str, key: str, properties: bytes, body: bytes, *, mandatory: bool) -> None:
        """Buffer a message for `flush`; the broker returns a `mandatory` message that no queue receives.

        Raises ValueError if a name is too long for AMQP or not valid Unicode.
        """
        method = b"".join((_PUBLISH, short_text(exchange), short_text(key), b"\1" if mandatory else b"\0"))
        header = pack(">HHQ", spec.Basic.INDEX, 0, len(body)) + properties
        frames = [_frame(spec.FRAME_METHOD, channel, method), _frame(spec.FRAME_HEADER, channel, header)]
        most = self._body_max_length
        frames += (_frame(spec.FRAME_BODY, channel, body[at : at + most]) for at in range(0, len(body), most))
        self._adapter_emit_data(b"".join(frames))

    def flush(self) -> None:
        """Write the frames to the socket as far as it accepts them; pika sends the rest later."""
        if self._frames:
            data, self._frames, self._size = b"".join(self._frames), [], 0
            if self._transport and not self.is_closed and (rest := data[self._sent(data) :]):
                super()._adapter_emit_data(rest)

    def abandon(self) -> None:
        """Give up the socket, whatever the connection's state; a callback of the loop closes it."""
        if not self.is_closed:
            self._terminate_stream(AMQPConnectionError("it was given up"))

    def _proto_connection_made(self, transport: Any) -> None:
        super()._proto_connection_made(transport)
        self._plain = type(transport._sock) is socket
        if self._plain:  # TLS buffers data that no poll reports
            transport._MAX_RECV_BYTES, transport._MAX_CONSUME_BYTES = READ_BYTES, 1

    def _sent(self, data: bytes) -> int:
        """Write as much of `data` as the socket accepts without waiting; return the size written [bytes].

        Return 0 for TLS, if older data is still waiting, or after an error, which pika handles.
        """
        transport = self._transport
        if not self._plain or transport.get_write_buffer_size():
            return 0
        try:
            return int(transport._sock.send(data))
        except OSError:
            return 0

    def _adapter_emit_data(self, data: bytes) -> None:
        self._frames.append(data)
        self._size += len(data)
        if self._size > FLUSH_BYTES:
            self.flush()

    def _on_data_available(self, data_in: bytes) -> None:
        if not self.is_open:
            super()._on_data_available(data_in)
            return
        data: bytes = self._frame_buffer + data_in
        at = 0
        while len(data) - at > _HEAD:
            kind, _, size = unpack_from(">BHL", data, at)
            end = at + _HEAD + size
            if end >= len(data):
                break
            if data[end] != spec.FRAME_END or not self._take(kind, data[at + _HEAD : end]):
                self._frame_buffer = data[at : end + 1]
                _, value = self._read_frame()
                self._process_frame(value)
            at = end + 1
        self._frame_buffer = data[at:]
        self.bytes_received += at

    def _take(self, kind: int, data: bytes) -> bool:
        """Process a frame's content; return False if pika must process it."""
        if kind == spec.FRAME_METHOD:
            if data.startswith(_ACK):
                number, several = unpack_from(">QB", data, 4)
                self._confirmed(number, bool(several))
                return True
            if data.startswith(_DELIVER):
                self._coming = _Coming(data)
                return True
            return False
        coming = self._coming
        if coming is None or kind not in (spec.FRAME_HEADER, spec.FRAME_BODY):
            return False
        if kind == spec.FRAME_HEADER:
            (coming.missing,) = unpack_from(">Q", data, 4)
            coming.properties = read_properties(data[12:])
        else:
            coming.parts.append(data)
            coming.missing -= len(data)
        if coming.missing <= 0:
            self._coming = None
            self._hand_on(coming)
        return True

    def _hand_on(self, coming: _Coming) -> None:
        if reader := self.readers.get(coming.consumer):
            body = coming.parts[0] if len(coming.parts) == 1 else b"".join(coming.parts)
            reader(coming.number, coming.again, coming.key, coming.properties, body)
        else:
            self._unread(coming.number)


def _frame(kind: int, channel: int, data: bytes) -> bytes:
    return pack(">BHL", kind, channel, len(data)) + data + _END


def _short(data: bytes, at: int) -> tuple[bytes, int]:
    """Return the short string at the index `at`, and the index after it."""
    start = at + 1
    end = start + data[at]
    return data[start:end], end
