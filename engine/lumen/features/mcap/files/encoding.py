"""Encodes bus messages as items of a recording: JSON with its schema, and pictures as images."""

import base64
import json
from collections.abc import Iterator, Mapping
from typing import Any

import orjson

from lumen.features.mcap.files.foxglove import NANO, compressed_image, foxglove_channel
from lumen.features.mcap.files.recorded import RecordedChannel, RecordedMessage
from lumen.language.projects import Project
from lumen.ports import Message

ORIGIN_KEY = "_lumen"
"""The key of a message's origin in its recorded body; a body that already has this key is wrapped in `value`."""
PICTURE = "data:image/jpeg;base64,"
ABOUT = ".about"
"""The suffix of the topic for the other fields of a picture's message."""
CAMERA = "camera"
"""The frame of reference of pictures."""
MAX_NANOSECONDS = 2**63 - 1
"""MCAP's latest time, in the year 2262."""
MAX_TOPICS = 4_096
"""The maximum number of cached channels."""

_ORIGIN_SCHEMA = {
    "type": "object",
    "description": "The message on the bus: its id, its sender, and its cause in the behaviour.",
    "properties": {name: {"type": "string"} for name in ("id", "sender", "cause", "reply_to", "correlation_id")},
}


def nanoseconds(moment: float) -> int:
    """Convert a time from [s] to [ns] since 1970, limited to MCAP's range because a sender can send any number.

    Return 0 for NaN.
    """
    return int(min(max(0, moment * NANO), MAX_NANOSECONDS))


class MessageEncoder:
    """Encodes the messages of a project's bus; `use` switches to another bundle."""

    def __init__(self, project: Project | None) -> None:
        self._schemas: Mapping[str, tuple[str, Mapping[str, object]]] = {}
        self._channels: dict[str, RecordedChannel] = {}
        self.use(project)

    def use(self, project: Project | None) -> None:
        """Encode with this project's schemas from now on; with None, without schemas."""
        routes = project.routes.values() if project else ()
        self._schemas = {
            key: (route.schema, project.messages[route.schema])
            for route in routes
            if project and route.schema in project.messages
            for key in (route.alias, route.key_for(project.robot))
        }
        self._channels = {}

    def encode(self, message: Message, came: float) -> Iterator[RecordedMessage]:
        """Yield the item for a message that arrived at `came` [s since 1970, in UTC]; a picture is a separate item."""
        at, sent = nanoseconds(came), nanoseconds(message.time)
        body, topic = message.body, message.key
        if jpeg := _jpeg(body):
            yield RecordedMessage(
                foxglove_channel(topic, "CompressedImage"), at, sent, compressed_image(jpeg, CAMERA, sent)
            )
            topic, body = topic + ABOUT, {key: value for key, value in body.items() if key != "contentUrl"}
        yield RecordedMessage(self._channel(topic), at, sent, json_bytes(_envelope(message, body)))

    def _channel(self, topic: str) -> RecordedChannel:
        if topic not in self._channels:
            if len(self._channels) >= MAX_TOPICS:
                self._channels = {}
            name, schema = self._schemas.get(topic.removesuffix(ABOUT), ("", {}))
            data = json.dumps(_open(schema)).encode()
            self._channels[topic] = RecordedChannel(
                topic, "json", f"lumen.{name}" if name else topic, "jsonschema", data
            )
        return self._channels[topic]


def origin_of(data: Mapping[str, Any]) -> tuple[Any, dict[str, str]]:
    """Return the body of a recorded message without its origin, and the origin; empty if it has none."""
    body = {key: value for key, value in data.items() if key != ORIGIN_KEY}
    said = data.get(ORIGIN_KEY)
    origin = dict(said) if isinstance(said, Mapping) else {}
    return (body.get("value") if origin.pop("wrapped", None) else body), origin


def json_bytes(data: Any) -> bytes:
    """Encode JSON data as bytes.

    A number that JSON lacks becomes null. Lone surrogates and integers above 64 bits, which orjson rejects, are kept.
    """
    try:
        return orjson.dumps(data)
    except TypeError:
        return json.dumps(json.loads(json.dumps(data), parse_constant=lambda _: None)).encode()


def _envelope(message: Message, body: Any) -> dict[str, Any]:
    """Return the body with the message's origin added.

    A body that is not an object, or that already has ORIGIN_KEY, is wrapped in `value`: Foxglove shows only objects.
    """
    plain = isinstance(body, Mapping) and ORIGIN_KEY not in body
    origin: dict[str, Any] = {
        name: value
        for name in ("id", "sender", "cause", "reply_to", "correlation_id")
        if (value := getattr(message, name))
    }
    if not plain:
        origin["wrapped"] = True
    return {**(body if plain else {"value": body}), ORIGIN_KEY: origin}


def _open(schema: Mapping[str, object]) -> dict[str, object]:
    """Return a recorded body's schema: the message's schema and the origin's; wrap a body that is not an object."""
    properties = schema.get("properties")
    own = dict(properties) if isinstance(properties, Mapping) else {}
    found = {"type": "object", **schema, "properties": {**own, ORIGIN_KEY: _ORIGIN_SCHEMA}}
    if found["type"] != "object":
        value = {key: each for key, each in schema.items() if key not in ("$schema", "$id", "properties")}
        return {"type": "object", "properties": {"value": value, ORIGIN_KEY: _ORIGIN_SCHEMA}}
    return found


def _jpeg(body: Any) -> bytes:
    """Return the JPEG in a body's `contentUrl`; empty if that is not a valid base64 data URL."""
    url = body.get("contentUrl") if isinstance(body, Mapping) else None
    if not isinstance(url, str) or not url.startswith(PICTURE):
        return b""
    try:
        return base64.b64decode(url[len(PICTURE) :], validate=True)
    except ValueError:
        return b""
