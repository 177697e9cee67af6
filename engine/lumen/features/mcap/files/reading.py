"""Reads a recording, up to where it is cut off or damaged."""

import struct
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from lumen.errors import RecordingError
from lumen.extras import demand
from lumen.features.mcap.files.recorded import Recorded, RecordedChannel, RecordedFile, RecordedMessage, RecordedNotes

MAGIC = b"\x89MCAP0\r\n"
END_BYTES = 8 + 9 + 20
"""The size of a complete recording's last record and the magic after it [bytes]."""
FOOTER = 0x02
MAX_RECORD_BYTES = 256_000_000
"""The largest valid record [bytes]; a larger size means damage."""


def whole(path: Path) -> bool:
    """Return whether a recording is complete. Raises RecordingError if it is unreadable, or not an MCAP file."""
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
    """Yield messages, attachments and metadata in file order, up to the end or the first damage.

    Raises RecordingError if the file is unreadable or not an MCAP file, MissingExtraError without `mcap`.
    """
    whole(path)
    demand("recording", "a recording", "mcap")
    try:
        with path.open("rb") as file:
            yield from _items(file)
    except OSError as error:
        raise RecordingError(f"{path} can't be read: {error.strerror}") from None


def _items(file: Any) -> Iterator[Recorded]:
    """Yield the items of records and verified chunks; stop at the first incomplete or damaged one."""
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
    """Return the exceptions that reading raises for damaged bytes, or at the end of the file."""
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
