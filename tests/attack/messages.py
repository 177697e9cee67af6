"""Hostile messages, from a `random.Random`: for a broker, and for the socket of the local bus.

    message(random, sound)  a key, the bytes of a body, and of its AMQP properties, for `Stranger.send`
    frame(random, keys)     bytes for the socket of the local bus: malformed frames, or frames with unexpected content
    Stranger(url)           a separate connection to a broker; `send`s messages that pika refuses, and reconnects if the
                            broker closes it, as RabbitMQ does for headers that streams reject (541, INTERNAL_ERROR)

`sound` has a valid body for each key that has an example: nearly valid input gets furthest. Each message comes from
one of a list of small generators, to which a new kind adds a function. The messages depend only on the seed, and are
never much larger than 64 KiB.
"""

import json
import struct
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from random import Random
from typing import Any, NamedTuple

import pika
from pika import BasicProperties
from pika.exceptions import AMQPError

MARK = "lumen.attack.mark"
LARGEST = 64 * 1024
"""The maximum length of a body, a table of headers or a frame [bytes]."""
METHODS = (
    "say",
    "rest",
    "stop",
    "wakeUp",
    "moveTo",
    "goToPosture",
    "perform",
    "setAngles",
    "record",
    "leds",
    "outcome",
    "stopped",
    "cancel",
    "move",
    "look",
    "status",
    "reload",
    "rollback",
    "brain",
    "robot",
    "dance",
    "all",
)
"""All methods except the one that ends a stop: `check` could not distinguish it from its own."""
NAMES = (
    "type", "method", "parameter", "id", "text", "result", "x", "y", "time", "name", "replace", "session", "parts",
    "state", "robot", "speed", "realtime", "follows", "bundle", "command", "now", "by", "what", "motion", "tracks",
    "colours", "duration", "jointNames", "angles", "yaw", "language", "visitor", "sensor", "track", "play", "reason",
)  # fmt: skip
"""Words of Lumen's own bodies: nearly valid input gets furthest."""
NUMBERS = (0, -1, 1, 2**31, 2**53 + 1, 2**63, -(2**63) - 1, 10**400, 0.1, 1e308, -1e308, 1e-320)
SHORT_FIELDS = ("content_type", "content_encoding", "correlation_id", "reply_to", "expiration", "message_id", "type")
_BITS = {
    "content_type": 15, "content_encoding": 14, "headers": 13, "delivery_mode": 12, "priority": 11,
    "correlation_id": 10, "reply_to": 9, "expiration": 8, "message_id": 7, "timestamp": 6, "type": 5,
}  # fmt: skip
"""The flag bit of each property that a broker does not check."""


class HostileMessage(NamedTuple):
    """A message as sent over the wire; `properties` are the bytes of the header's frame from the flags on."""

    key: str | bytes
    body: bytes
    properties: bytes


class RawProperties(BasicProperties):  # type: ignore[misc]  # pika is not typed
    """Properties that are sent as they are given."""

    def __init__(self, raw: bytes) -> None:
        super().__init__()
        self._raw = raw

    def encode(self) -> list[bytes]:
        return [self._raw]


class Stranger:
    """A client with its own connection to the broker at `url`; `ended` counts how often the broker closed it.

    The last message before a close is lost, so checks after an attack use another connection.
    """

    def __init__(self, url: str) -> None:
        self.ended = 0
        self._url = url
        self._connection: Any = None

    def send(self, message: HostileMessage) -> None:
        """Publish the message on `amq.topic` without pika's checks; if the broker has hung up, connect again."""
        try:
            self._publish(message)
        except AMQPError:
            self.ended += 1
            self._connection = None
            self._publish(message)

    def settle(self) -> None:
        """Wait until the broker has processed all sent messages: it handles requests in order."""
        try:
            if self._connection:
                self._channel.queue_declare(MARK, exclusive=True)
        except AMQPError:
            self.ended += 1
            self._connection = None

    def close(self) -> None:
        with suppress(AMQPError):
            if self._connection:
                self._connection.close()

    def _publish(self, message: HostileMessage) -> None:
        if self._connection is None:
            self._connection = pika.BlockingConnection(pika.URLParameters(self._url))
            self._channel = self._connection.channel()
        self._channel.basic_publish("amq.topic", message.key, message.body, RawProperties(message.properties))
        self._connection.process_data_events(0)


def message(random: Random, sound: Mapping[str, Any]) -> HostileMessage:
    """Return a message under a key of `sound`, with an error in its body, its properties, or both."""
    key = random.choice(list(sound))
    body = _spoilt(random, sound[key]) if random.random() < 0.4 else random.choice(BODIES)(random)
    return HostileMessage(key, body, random.choice(PROPERTIES)(random))


def frame(random: Random, keys: Sequence[str]) -> bytes:
    """Return hostile bytes for the socket of a local bus; some publish under one of the `keys`."""
    return random.choice(FRAMES)(random, keys)


def encoded(**fields: bytes | int) -> bytes:
    """Return properties as sent over the wire: short strings, a table for `headers`, and numbers."""
    flags, parts = 0, list[bytes]()
    for name, bit in _BITS.items():
        if (value := fields.get(name)) is None:
            continue
        flags |= 1 << bit
        if isinstance(value, int):
            parts.append(struct.pack(">Q" if name == "timestamp" else "B", value))
        else:
            parts.append(struct.pack(">I" if name == "headers" else "B", len(value)) + value)
    return struct.pack(">H", flags) + b"".join(parts)


def header(name: bytes, kind: bytes, value: bytes) -> bytes:
    """Return one field of a table of headers."""
    return struct.pack("B", len(name)) + name + kind + value


def nested(depth: int) -> bytes:
    """Return a table of headers that is nested `depth` deep."""
    table = b""
    for _ in range(depth):
        table = header(b"a", b"F", struct.pack(">I", len(table)) + table)
    return table


def noise(random: Random) -> bytes:
    """Return random bytes, 1 to 199."""
    return random.randbytes(random.randrange(1, 200))


def value(random: Random, depth: int = 4) -> Any:
    """Return random JSON data, nested at most `depth` deep; the keys of its objects are Lumen's own words."""
    kind = random.randrange(7 if depth else 5)
    match kind:
        case 0:
            return random.choice(NUMBERS)
        case 1:
            return random.choice((True, False, None))
        case 2:
            return random.choice(METHODS)
        case 3:
            return "".join(chr(random.randrange(1, 0xD800)) for _ in range(random.randrange(40)))
        case 4:
            return random.choice(("", " ", "\x1b[2J", "../../etc/passwd", "{{ visitor }}", "x" * 5_000, "\ufeff"))
        case 5:
            return [value(random, depth - 1) for _ in range(random.randrange(5))]
        case _:
            return {random.choice(NAMES): value(random, depth - 1) for _ in range(random.randrange(6))}


def _spoilt(random: Random, sound: Any) -> bytes:
    """Return the valid body `sound` with an error in one value or name."""
    if not isinstance(sound, dict) or not sound:
        return _data(random)
    body, name = dict(sound), random.choice(list(sound))
    if isinstance(body[name], dict) and body[name] and random.random() < 0.5:
        body[name] = json.loads(_spoilt(random, body[name]))
    else:
        body[random.choice((name, random.choice(NAMES)))] = value(random)
    return json.dumps(body).encode()


def _data(random: Random) -> bytes:
    return json.dumps(value(random)).encode()


def _order(random: Random) -> bytes:
    """Return a command with random values, of which some fields may be missing."""
    body = {"type": "motion", "method": random.choice(METHODS), "parameter": value(random), "id": value(random, 0)}
    return json.dumps({key: body[key] for key in body if random.random() < 0.8}).encode()


def _deep(random: Random) -> bytes:
    depth = random.choice((64, 65, 1_000, 30_000))
    return b"[" * depth + b"]" * random.choice((0, depth))


def _digits(random: Random) -> bytes:
    return b'{"x": ' + random.choice((b"", b"-", b"0.", b"1e")) + b"9" * random.choice((20, 400, 5_000)) + b"}"


def _cut(random: Random) -> bytes:
    whole = _order(random)
    return whole[: random.randrange(len(whole))]


def _long(random: Random) -> bytes:
    return b'{"text": "' + b"la " * random.randrange(LARGEST // 4) + b'"}'


def _constants(random: Random) -> bytes:
    return random.choice((b"NaN", b"[Infinity]", b'{"x": -Infinity}', b"", b"\xff", b"\x00", b'"\\ud800"', b"nul"))


BODIES: tuple[Callable[[Random], bytes], ...] = (noise, _data, _order, _deep, _digits, _cut, _long, _constants)
"""The kinds of bodies."""


def _usual(random: Random) -> bytes:
    return encoded(content_type=b"application/json", reply_to=b"lumen.attack.answer", correlation_id=b"1")


def _no_text(random: Random) -> bytes:
    """Return properties whose short strings are not UTF-8."""
    chosen = random.sample(SHORT_FIELDS, random.randrange(1, len(SHORT_FIELDS)))
    return encoded(**{name: b"\xff\xfe" + random.randbytes(3) for name in chosen if name != "expiration"})


def _answer(random: Random) -> bytes:
    """Return properties whose `reply_to` has no recipient, or the wrong one."""
    places = (
        b"amq.rabbitmq.reply-to.x",
        b"lumen.#",
        b"avatar.NAO.command",
        b"*" * 255,
        b"lumen." + b"x" * 249,
        b"\x00",
    )
    return encoded(reply_to=random.choice(places), correlation_id=random.randbytes(random.randrange(256)))


def _date(random: Random) -> bytes:
    """Return properties with a date that no calendar has."""
    far = random.choice((2**63, 2**64 - 1, 2**40))
    return encoded(timestamp=far, headers=header(b"at", b"T", struct.pack(">Q", far)))


def _tables(random: Random) -> bytes:
    return encoded(headers=nested(random.choice((1, 100, 3_000))))


def _headers(random: Random) -> bytes:
    """Return headers of all kinds whose names are not text; RabbitMQ can't read the infinite number among them."""
    kinds = ((b"t", b"\x02"), (b"d", b"\x7f\xef" + b"\xff" * 6), (b"D", b"\xff" + b"\xff" * 4), (b"V", b""))
    long = (b"S", struct.pack(">I", 30_000) + b"\xff" * 30_000)
    fields = (random.choice((*kinds, long)) for _ in range(random.randrange(1, 4)))
    return encoded(headers=b"".join(header(random.randbytes(5), *field) for field in fields))


def _same(random: Random) -> bytes:
    """Return properties with an id that other messages have, too."""
    return encoded(message_id=str(random.randrange(3)).encode(), delivery_mode=2, priority=random.randrange(256))


PROPERTIES: tuple[Callable[[Random], bytes], ...] = (_usual, _no_text, _answer, _date, _tables, _headers, _same)
"""The kinds of properties."""


def framed(data: bytes) -> bytes:
    """Return a frame that holds these bytes."""
    return struct.pack(">I", len(data)) + data


def _told(random: Random, keys: Sequence[str]) -> bytes:
    """Return a frame with a word that the bus knows, and random values after it."""
    words = ("publish", "subscribe", "unsubscribe", "mark", "proof", "prove", "message", "subscribed", "marked")
    return framed(json.dumps([random.choice(words), *(value(random, 2) for _ in range(random.randrange(7)))]).encode())


def _published(random: Random, keys: Sequence[str]) -> bytes:
    """Return a frame that publishes a message, with one wrong field."""
    words = ["publish", random.choice(keys), "lumen.attack.answer", "1", random.choice((None, 1.0))]
    words[random.randrange(len(words))] = value(random, 1)
    return framed(json.dumps(words).encode()[:-1] + b"," + random.choice(BODIES)(random) + b"]")


def _digited(random: Random, keys: Sequence[str]) -> bytes:
    """Return a frame whose time to live is a number of hundreds of digits."""
    return framed(
        b'["publish","%s","","",%s,1]' % (random.choice(keys).encode(), b"9" * random.choice((300, 400, 5_000)))
    )


def _length(random: Random, keys: Sequence[str]) -> bytes:
    """Return bytes whose length field is wrong."""
    return struct.pack(">I", random.choice((0, 1, 2**20 + 4_097, 2**32 - 1))) + noise(random)


def _unmeant(random: Random, keys: Sequence[str]) -> bytes:
    return random.choice((noise(random), framed(noise(random)), framed(_deep(random)), framed(_constants(random))))


FRAMES: tuple[Callable[[Random, Sequence[str]], bytes], ...] = (_told, _published, _digited, _length, _unmeant)
"""The kinds of frames."""
