"""What is in a recording, as far as it can be read: one that was cut ends where it was cut."""

import struct
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from lumen.errors import RecordingError
from lumen.extras import demand
from lumen.features.mcap.files.recorded import Recorded, RecordedChannel, RecordedFile, RecordedMessage, RecordedNotes

MAGIC = b"\x89MCAP0\r\n"
END_BYTES = 8 + 9 + 20
"""The last record of a whole recording and the magic after it."""
FOOTER = 0x02
MAX_RECORD_BYTES = 256_000_000
"""A record that says to be longer is damage."""


def whole(path: Path) -> bool:
    """Whether a recording was written to its end, with its index. Raises RecordingError where it is none."""
    try:
        with path.open("rb") as file:
            if file.read(len(MAGIC)) != MAGIC:
                raise RecordingError(f"{path} is not a recording: it is not an MCAP file")
            size = file.seek(0, 2)
            file.seek(max(0, size - END_BYTES))
            end = file.read()
    except OSError as error:
        raise RecordingError(f"{path} can't be read: {error.strerror}") from None
    return len(end) == END_BYTES and end[0] == FOOTER and end.endswith(MAGIC)


def read_recording(path: Path) -> Iterator[Recorded]:
    """Messages, attachments and metadata in their order, until the end or where it was cut.

    Raises RecordingError where it is no recording.
    """
    whole(path)
    demand("recording", "a recording", "mcap")
    try:
        with path.open("rb") as file:
            yield from _items(file)
    except OSError as error:
        raise RecordingError(f"{path} can't be read: {error.strerror}") from None


def _items(file: Any) -> Iterator[Recorded]:
    """A piece that is cut or damaged is the end; what came before it was checked."""
    from mcap.records import Attachment, Channel, Chunk, Message, Metadata, Schema
    from mcap.stream_reader import StreamReader, breakup_chunk

    schemas: dict[int, Schema] = {}
    channels: dict[int, RecordedChannel] = {}
    records = StreamReader(file, emit_chunks=True, record_size_limit=MAX_RECORD_BYTES).records
    damage = _damage()
    while True:
        found = list[Recorded]()
        try:
            record = next(records)
            inner = breakup_chunk(record, validate_crc=True) if isinstance(record, Chunk) else [record]
            for each in inner:
                match each:
                    case Schema():
                        schemas[each.id] = each
                    case Channel():
                        form = schemas.get(each.schema_id)
                        said = (form.name, form.encoding, form.data) if form else ("", "", b"")
                        channels[each.id] = RecordedChannel(each.topic, each.message_encoding, *said)
                    case Message():
                        message = channels[each.channel_id], each.log_time, each.publish_time, each.data
                        found.append(RecordedMessage(*message))
                    case Attachment():
                        found.append(RecordedFile(each.name, each.media_type, each.data, each.log_time))
                    case Metadata():
                        found.append(RecordedNotes(each.name, tuple(each.metadata.items())))
        except damage:
            return
        yield from found


def _damage() -> tuple[type[Exception], ...]:
    """What mcap and the unpackers beneath it raise for bytes that are none of theirs."""
    from mcap.exceptions import McapError
    from zstandard import ZstdError

    return (
        StopIteration,
        McapError,
        ZstdError,
        struct.error,
        ValueError,
        LookupError,
        RuntimeError,
        MemoryError,
        EOFError,
    )
