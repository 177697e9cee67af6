"""Writes a recording; after a crash, all but the last half second can be read."""

import os
import time
from collections.abc import Iterable
from pathlib import Path
from typing import Any, assert_never

from lumen.errors import RecordingError
from lumen.extras import demand
from lumen.features.mcap.files.recorded import Recorded, RecordedChannel, RecordedFile, RecordedMessage, RecordedNotes
from lumen.upkeep.own_folders import NO_LINK

CHUNK_BYTES = 64_000
"""The size of a chunk [bytes]. Only complete chunks can be read: with the library's 1 MB, a kill left nothing."""
CHUNK_PERIOD = 0.5
"""The longest time until a chunk is completed [s]."""
SYNC_PERIOD = 2.0
"""The time between two syncs of the file to the disk [s]."""
MAX_CHANNELS = 60_000
"""The maximum number of channels, which MCAP counts with 16 bits; messages of further channels are left out."""


def demand_recording() -> None:
    """Raise MissingExtraError if a package for recordings is not installed."""
    demand("recording", "a recording", "mcap", "google.protobuf", "foxglove_schemas_protobuf")


class RecordingFile:
    """Writes a new recording, readable only by its owner; `messages` is the number of written messages.

    Raises MissingExtraError if a package is missing, and OSError if the disk fails: the file can then be repaired.
    """

    def __init__(self, path: Path) -> None:
        demand_recording()
        from mcap.writer import Writer  # takes 0.4 s, and only recording needs it

        self.path, self.messages = path, 0
        handle = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_TRUNC | NO_LINK, 0o600)
        self._file: Any = open(handle, "wb")  # noqa: SIM115  it is closed by `finish`
        self._writer: Any = Writer(self._file, chunk_size=CHUNK_BYTES)
        self._writer.start(profile="", library="lumen")
        self._channels: dict[RecordedChannel, int] = {}
        self._schemas: dict[tuple[str, str, bytes], int] = {}
        self._closed = self._synced = time.monotonic()

    @property
    def bytes(self) -> int:
        """The size of the file [bytes]."""
        return int(self._file.tell())

    def write(self, items: Iterable[Recorded]) -> None:
        """Write these items in order; leave out messages of channels beyond the first `MAX_CHANNELS`."""
        for item in items:
            match item:
                case RecordedMessage(channel, came, sent, data):
                    number = self._channels.get(channel) or self._number(channel)
                    if number:
                        self.messages += 1
                        self._writer.add_message(number, came, data, sent, self.messages & 0xFFFFFFFF)
                case RecordedFile(name, kind, data, at):
                    self._writer.add_attachment(at, at, name, kind, data)
                case RecordedNotes(name, words):
                    self._writer.add_metadata(name, dict(words))
                case _:
                    assert_never(item)

    def settle(self) -> None:
        """Complete the current chunk and sync the file to the disk, each if it is due."""
        now = time.monotonic()
        if now - self._closed >= CHUNK_PERIOD:
            self._closed = now
            self._writer.flush()
        if now - self._synced >= SYNC_PERIOD:
            self._synced = now
            os.fsync(self._file.fileno())

    def finish(self) -> None:
        """Write the index and close the file. Raises OSError if the disk fails; the file is closed all the same."""
        try:
            self._writer.finish()
            self._file.flush()
            os.fsync(self._file.fileno())
        finally:
            self.abandon()

    def abandon(self) -> None:
        """Close the file without an index; further calls do nothing."""
        try:
            self._file.close()
        except OSError:  # the disk refuses the buffered bytes
            return

    def _number(self, channel: RecordedChannel) -> int:
        """Register a channel and return its number; return 0 if there are `MAX_CHANNELS` already."""
        if len(self._channels) >= MAX_CHANNELS:
            return 0
        form = channel.form, channel.language, channel.schema
        if form not in self._schemas:
            self._schemas[form] = self._writer.register_schema(*form)
        number: int = self._writer.register_channel(channel.topic, channel.encoding, self._schemas[form])
        self._channels[channel] = number
        return number


def renamed(wanted: Path, path: Path) -> str:
    """Return a notice if a recording's path differs from the wanted one, else the empty text."""
    return f"{wanted} already exists: this recording is saved as {path}" if path != wanted else ""


def writable(path: Path) -> Path:
    """Return the path for a new recording: `path`, or with a number in its name if that exists.

    Raises RecordingError if its folder is missing.
    """
    if not path.parent.is_dir():
        raise RecordingError(f"{path} can't be written: the folder {path.parent} does not exist")
    number = 2
    found = path
    while found.exists() or found.is_symlink():
        found = path.with_name(f"{path.stem}-{number}{path.suffix}")
        number += 1
    return found
