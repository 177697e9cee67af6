"""Messages of a bus as messages of a recording: JSON with its schema, pictures as pictures."""

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
"""Under which a recorded body says where its message comes from; a body that has the key itself is put into `value`."""
PICTURE = "data:image/jpeg;base64,"
ABOUT = ".about"
"""What follows the topic of a picture for what else its message said."""
CAMERA = "camera"
"""The frame of reference of pictures."""
MAX_NANOSECONDS = 2**63 - 1
"""The year 2262."""
MAX_TOPICS = 4_096
"""Keys whose channels are remembered."""

_ORIGIN_SCHEMA = {
    "type": "object",
    "description": "The message on the bus: its id, its sender, and its cause in the behaviour.",
    "properties": {
        name: {"type": "string"} for name in ("id", "sender", "cause", "reply_to", "correlation_id")
    },
}  # fmt: skip


def nanoseconds(moment: float) -> int:
    """A time [s since 1970] in [ns], as far as MCAP can say it: a sender may say any."""
    return min(max(int(moment * NANO), 0), MAX_NANOSECONDS)


class MessageEncoder:
    """Encodes messages of a project's bus; with another bundle, `use` it."""

    def __init__(self, project: Project | None) -> None:
        self._schemas: Mapping[str, tuple[str, Mapping[str, object]]] = {}
        self._channels: dict[str, RecordedChannel] = {}
        self.use(project)

    def use(self, project: Project | None) -> None:
        """Encode with the schemas of these files from now on; without a project, with none."""
        routes = project.routes.values() if project else ()
        self._schemas = {
            key: (route.schema, project.messages[route.schema])
            for route in routes
            if project and route.schema in project.messages
            for key in (route.alias, route.key_for(project.robot))
        }
        self._channels = {}

    def encode(self, message: Message, came: float) -> Iterator[RecordedMessage]:
        """What is written of a message that came then [s since 1970, in UTC]."""
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
    """The body of a recorded message, and what was said of where it comes from."""
    body = {key: value for key, value in data.items() if key != ORIGIN_KEY}
    said = data.get(ORIGIN_KEY)
    origin = dict(said) if isinstance(said, Mapping) else {}
    return (body.get("value") if origin.pop("wrapped", None) else body), origin


def json_bytes(data: Any) -> bytes:
    """JSON data as it stands in a recording; half characters and numbers that are none, which JSON may bring, too."""
    try:
        return orjson.dumps(data)
    except TypeError:
        return json.dumps(data).encode("utf-8", "replace")


def _envelope(message: Message, body: Any) -> dict[str, Any]:
    """Foxglove shows objects: any other body is the `value` of one."""
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
    """The schema of a body with what a recording adds to it."""
    properties = schema.get("properties")
    own = dict(properties) if isinstance(properties, Mapping) else {}
    found = {"type": "object", **schema, "properties": {**own, ORIGIN_KEY: _ORIGIN_SCHEMA}}
    if found["type"] != "object":
        value = {key: each for key, each in schema.items() if key not in ("$schema", "$id", "properties")}
        return {"type": "object", "properties": {"value": value, ORIGIN_KEY: _ORIGIN_SCHEMA}}
    return found


def _jpeg(body: Any) -> bytes:
    """The picture in a body, empty where there is none."""
    url = body.get("contentUrl") if isinstance(body, Mapping) else None
    if not isinstance(url, str) or not url.startswith(PICTURE):
        return b""
    try:
        return base64.b64decode(url[len(PICTURE) :], validate=True)
    except ValueError:
        return b""
