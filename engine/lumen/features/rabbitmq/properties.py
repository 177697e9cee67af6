"""Reads a message's AMQP properties without letting invalid ones end the connection.

pika decodes all headers, including deep tables and invalid dates, and raises while it reads frames: a single message
can end the connection. `read_properties` decodes only two headers: the text `cause`, if only texts come before it, and
the message's offset in a stream. It leaves out texts that are not valid Unicode, and lists the
names of those properties.
"""

from collections.abc import Callable, Mapping
from contextlib import suppress
from struct import Struct, pack, unpack_from
from struct import error as struct_error
from typing import Any, NamedTuple

import pika
from pika import frame, spec
from pika.data import encode_table

_HEADER_START = spec.FRAME_HEADER_SIZE + 12
"""The index of the properties in a header frame: after the class, the weight and the body's length."""
CAUSE_HEADER = "cause"
"""The header with the place in a behaviour that caused a message."""
OFFSET_HEADER = "x-stream-offset"
"""The header with a message's position in a RabbitMQ stream."""
_FIELDS = (
    ("content_type", "text"), ("content_encoding", "text"), ("headers", "table"), ("delivery_mode", "byte"),
    ("priority", "byte"), ("correlation_id", "text"), ("reply_to", "text"), ("expiration", "text"),
    ("message_id", "text"), ("timestamp", "time"), ("type", "text"), ("user_id", "text"), ("app_id", "text"),
    ("cluster_id", "text"),
)  # fmt: skip
"""AMQP 0-9-1's message properties in the order of their flags, from the highest bit."""


class MessageProperties(NamedTuple):
    """The properties of a message that Lumen uses."""

    content_type: str = ""
    correlation_id: str = ""
    reply_to: str = ""
    message_id: str = ""
    type: str = ""
    timestamp: int = 0
    app_id: str = ""
    delivery_mode: int = 0
    headers: str = ""
    """The text of `CAUSE_HEADER`; empty if missing."""
    offset: int = -1
    """The position in a RabbitMQ stream; -1 for other messages."""
    table: bytes = b""
    """All headers, undecoded; `header_fields` reads them."""
    unreadable: tuple[str, ...] = ()
    """The names of unreadable properties; `the rest` for truncated data."""
    content_encoding: str = ""


class TolerantConnection(pika.SelectConnection):  # type: ignore[misc]  # pika is not typed
    """pika's connection, but with `read_properties` for the properties of messages."""

    def _read_frame(self) -> tuple[int, Any]:
        data = self._frame_buffer
        if len(data) < _HEADER_START or data[0] != spec.FRAME_HEADER:
            return super()._read_frame()  # type: ignore[no-any-return]
        _, channel, size = unpack_from(">BHL", data)
        end = spec.FRAME_HEADER_SIZE + size + spec.FRAME_END_SIZE
        if end > len(data) or data[end - 1] != spec.FRAME_END:
            return super()._read_frame()  # type: ignore[no-any-return]
        (length,) = unpack_from(">Q", data, _HEADER_START - 8)
        return end, frame.Header(channel, length, read_properties(data[_HEADER_START : end - 1]))


def read_properties(data: bytes) -> MessageProperties:
    """Return the properties in these bytes of a header frame; `unreadable` lists invalid properties."""
    found: dict[str, Any] = {}
    unreadable: list[str] = []
    try:
        flags, at = _flags(data)
        for bit, (name, kind) in zip(range(15, 1, -1), _FIELDS, strict=True):
            if flags & 1 << bit:
                start, (value, at) = at, _READERS[kind](data, at)
                if kind == "table":
                    found["table"] = data[start + 4 : at]
                    found["offset"] = _offset(found["table"])
                if value is None:
                    unreadable.append(name)
                elif name in MessageProperties._fields:
                    found[name] = value
    except struct_error:
        unreadable.append("the rest")
    return MessageProperties(**found, unreadable=tuple(unreadable))


def write_properties(said: Mapping[str, Any]) -> bytes:
    """Encode these properties, whose names are those of AMQP; leave out empty ones.

    Raises ValueError if a text is longer than 255 bytes or not valid Unicode.
    """
    flags, parts = 0, [b""]
    for bit, (name, kind) in zip(range(15, 1, -1), _FIELDS, strict=True):
        if value := said.get(name):
            flags |= 1 << bit
            parts.append(_WRITERS[kind](value))
    parts[0] = pack(">H", flags)
    return b"".join(parts)


def short_text(text: str) -> bytes:
    """Encode a text of at most 255 bytes as AMQP's short string. Raises ValueError if it is longer."""
    said = text.encode()
    return bytes((len(said),)) + said


def _flags(data: bytes) -> tuple[int, int]:
    """Return the first word of the flags and the end of the last word; a set lowest bit means that a word follows."""
    at, word = 2, unpack_from(">H", data)[0]
    first = word
    while word & 1:
        word, at = unpack_from(">H", data, at)[0], at + 2
    return first, at


def _text(data: bytes, at: int) -> tuple[str | None, int]:
    end = at + 1 + unpack_from("B", data, at)[0]
    try:
        return data[at + 1 : end].decode(), end
    except UnicodeDecodeError:
        return None, end


def _table(data: bytes, at: int) -> tuple[str | None, int]:
    start = at + 4
    end = start + unpack_from(">I", data, at)[0]
    return _cause(data[start:end]), end


def _cause(table: bytes) -> str:
    """Return the text `cause` of a table if only texts come before it, else an empty string.

    Each entry consists of a name, an `S` and a text.
    """
    at = 0
    while at < len(table):
        named = at + 1 + table[at]
        if table[named : named + 1] != b"S" or len(table) < named + 5:
            break
        said = named + 5
        name, at = table[at + 1 : named], said + unpack_from(">I", table, named + 1)[0]
        if name == CAUSE_HEADER.encode():
            return table[said:at].decode(errors="replace")
    return ""


def _offset(table: bytes) -> int:
    """Return the value of `OFFSET_HEADER` in a table; -1 if it is missing or can't be read.

    Each entry consists of a name, a type letter and a value.
    """
    name = OFFSET_HEADER.encode()
    at = 0
    with suppress(struct_error):
        while name in table[at:]:
            named = at + 1 + table[at]
            sign, value = table[named : named + 1], named + 1
            if table[at + 1 : named] == name and sign == b"l":
                return max(-1, int(unpack_from(">q", table, value)[0]))
            if sign not in _LONG and sign not in _SIZES:
                break
            at = value + (4 + unpack_from(">I", table, value)[0] if sign in _LONG else _SIZES[sign])
    return -1


def header_fields(table: bytes) -> dict[str, str | int]:
    """Return the texts, integers and booleans among the headers, up to the first invalid header."""
    found: dict[str, str | int] = {}
    at = 0
    with suppress(struct_error, IndexError, UnicodeDecodeError):
        while at < len(table):
            named = at + 1 + table[at]
            name, sign, value = table[at + 1 : named].decode(), table[named : named + 1], named + 1
            if sign in _LONG:
                start = value + 4
                at = start + unpack_from(">I", table, value)[0]
                if sign == b"S" and at <= len(table):
                    found[name] = table[start:at].decode()
            elif sign in _SIZES:
                at = value + _SIZES[sign]
                if sign in _NUMBERS:
                    found[name] = unpack_from(_NUMBERS[sign], table, value)[0]
            else:
                break
    return found


def _table_of(entries: dict[str, Any]) -> bytes:
    pieces: list[bytes] = []
    encode_table(pieces, entries)
    return b"".join(pieces)


def _byte(data: bytes, at: int) -> tuple[int | None, int]:
    return unpack_from("B", data, at)[0], at + 1


def _time(data: bytes, at: int) -> tuple[int | None, int]:
    return unpack_from(">Q", data, at)[0], at + 8


_LONG = frozenset((b"S", b"A", b"F", b"x"))
"""The type letters of values that begin with their length."""
_SIZES = {
    b"t": 1, b"b": 1, b"B": 1, b"s": 2, b"u": 2, b"I": 4, b"i": 4, b"f": 4, b"D": 5, b"l": 8, b"d": 8, b"T": 8, b"V": 0,
}  # fmt: skip
"""The type letters of values with a fixed size, and that size as RabbitMQ writes it [bytes]."""
_NUMBERS = {
    b"t": ">?", b"b": ">b", b"B": ">B", b"s": ">h", b"u": ">H", b"I": ">i", b"i": ">I", b"l": ">q",
}  # fmt: skip
"""The `struct` formats of integers and booleans, by type letter."""
_READERS: dict[str, Any] = {"text": _text, "table": _table, "byte": _byte, "time": _time}
_WRITERS: dict[str, Callable[[Any], bytes]] = {
    "text": short_text,
    "table": _table_of,
    "byte": Struct("B").pack,
    "time": Struct(">Q").pack,
}
