"""Recordings for tests."""

import base64
from collections.abc import Iterator
from io import BytesIO
from pathlib import Path
from typing import Any

import orjson
from mcap.reader import make_reader
from mcap.records import Message as McapMessage
from mcap.stream_reader import StreamReader

from lumen.features.mcap.files.encoding import MessageEncoder, origin_of
from lumen.features.mcap.files.recorded import RecordedMessage
from lumen.features.mcap.files.recording_file import RecordingFile
from lumen.ports import Message

BEGAN = 1_790_000_000.0
JPEG = bytes(range(256)) * 4
ENCODER = MessageEncoder(None)


def said(key: str, body: Any, at: float = 0.0) -> Message:
    return Message(key, body, id=f"m{at:g}", sender="a test", time=BEGAN + at, cause="d3")


def picture(at: float = 0.0) -> Message:
    url = "data:image/jpeg;base64," + base64.b64encode(JPEG).decode()
    return said("avatar.NAO.data.image", {"name": "1", "contentType": "image/jpeg", "contentUrl": url}, at)


def encoded(*messages: Message) -> list[RecordedMessage]:
    return [item for message in messages for item in ENCODER.encode(message, message.time)]


def write(path: Path, *messages: Message) -> Path:
    file = RecordingFile(path)
    file.write(encoded(*messages))
    file.finish()
    return path


def bodies(path: Path) -> list[tuple[str, Any]]:
    """Read a recording with mcap's indexed reader; return topics and bodies, without the bodies' origins."""
    with path.open("rb") as file:
        found = list(make_reader(file, validate_crcs=True).iter_messages())
    return [
        (
            channel.topic,
            origin_of(orjson.loads(message.data))[0] if channel.message_encoding == "json" else message.data,
        )
        for _, channel, message in found
    ]


def readable(data: bytes) -> Iterator[bytes]:
    """Yield the messages that mcap's own reader finds in a truncated recording, from the front."""
    records = StreamReader(BytesIO(data)).records
    while True:
        try:
            record = next(records)
        except Exception:  # whatever it stumbles over is the cut
            return
        if isinstance(record, McapMessage):
            yield record.data
