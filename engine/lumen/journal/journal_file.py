"""One file of the journal of inputs: a header line, then frames of entries, each of which is a line of JSON.

A frame is its length and the CRC-32 of its content (4 bytes each, little-endian), and the content: a piece of one
deflate stream that spans all frames, flushed at the end of each. So repeated text takes little space, and every frame
can be read as soon as it is written.
"""

import json
import struct
import zlib
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any, NamedTuple

import orjson

from lumen.errors import JournalError
from lumen.insight.replay.entries import RecordedEntry, entry_data, read_entry
from lumen.talk.hearing import MATCHER
from lumen.upkeep.regular_files import read_regular

_HEAD = struct.Struct("<II")
MAX_FRAME_BYTES = 64_000_000
"""A frame with a greater length is damaged [bytes]."""
MAX_TEXT_BYTES = 64_000_000
"""The largest content of one frame, unpacked [bytes]."""


class FramePacker:
    """Packs texts into frames of one stream."""

    def __init__(self) -> None:
        self._deflate = zlib.compressobj(6)

    def pack(self, text: bytes) -> bytes:
        """Return the next frame, which holds this text."""
        content = self._deflate.compress(text) + self._deflate.flush(zlib.Z_SYNC_FLUSH)
        return _HEAD.pack(len(content), zlib.crc32(content)) + content


def unpack(data: bytes, start: int = 0) -> Iterator[tuple[bytes, int]]:
    """Yield the texts of the frames from `start` on, each with the offset of its end, until one is cut or damaged."""
    inflate, at = zlib.decompressobj(), start
    while at + _HEAD.size <= len(data):
        length, crc = _HEAD.unpack_from(data, at)
        content = data[at + _HEAD.size : at + _HEAD.size + length]
        if length > MAX_FRAME_BYTES or len(content) < length or zlib.crc32(content) != crc:
            return
        try:
            text = inflate.decompress(content, MAX_TEXT_BYTES)
        except zlib.error:
            return
        if inflate.unconsumed_tail:
            return
        at += _HEAD.size + length
        yield text, at


JOURNAL_VERSION = 1
JOURNAL_SUFFIX = ".journal"
MAX_HEADER_BYTES = 10_000
MAX_FILE_BYTES = 256_000_000
"""The largest file that is read [bytes]; the writer begins a new file at a much smaller size."""

encode = json.JSONEncoder(ensure_ascii=False, separators=(",", ":")).encode


class JournalHeader(NamedTuple):
    """The first line of a file."""

    first: int
    """The position of the file's first entry, which holds the state of the behaviour."""
    run: str
    """The id of the run that wrote the file."""
    bundle: str
    """The hash of the files that ran."""
    began: float
    """When the file was opened [s since 1970]."""
    story: str = ""
    """The name of the story that was played, if any."""
    version: int = JOURNAL_VERSION
    matcher: int = 0
    """The version of the rules by which sentences matched their rows; 0 if no state `hears`."""

    def line(self) -> bytes:
        said = self._asdict()
        if not self.matcher:
            del said["matcher"]
        return encode({"lumen-journal": said.pop("version"), **said}).encode() + b"\n"


class JournalContent(NamedTuple):
    """The content of one file of the journal."""

    header: JournalHeader
    """The header of the file."""
    entries: tuple[RecordedEntry, ...]
    """The entries that could be read."""
    whole: bool
    """Whether the file was readable to its last byte."""


def read_header(line: bytes, name: str) -> JournalHeader:
    """Return the header in a line. Raises JournalError, with a remedy, for other text or another version of Lumen."""
    try:
        data = json.loads(line)
        version = data.pop("lumen-journal")
        header = JournalHeader(
            int(data["first"]), str(data["run"]), str(data["bundle"]), float(data["began"]), str(data.get("story", "")),
            matcher=int(data.get("matcher", 0)),
        )  # fmt: skip
    except (ValueError, TypeError, KeyError, AttributeError, RecursionError):
        raise JournalError(f"{name} is not a journal, or its first line is incomplete: it can't be read") from None
    if version != JOURNAL_VERSION:
        raise JournalError(
            f"{name} was written by another version of Lumen (the journal has version {version}, but this Lumen reads"
            f" {JOURNAL_VERSION}): replay it with that version"
        )
    if header.matcher > MATCHER:
        raise JournalError(
            f"{name} was written by a later version of Lumen (it uses version {header.matcher} of the rules for"
            f" sentences, but this version has {MATCHER}): replay it with that version"
        )
    return header


def header_of(file: Path) -> JournalHeader:
    """Return the header of a file without reading the rest. Raises JournalError if it cannot be read."""
    try:
        with file.open("rb") as opened:
            return read_header(opened.readline(MAX_HEADER_BYTES), file.name)
    except OSError as error:
        raise JournalError(f"{file} can't be read: {error.strerror}") from None


def read_journal(file: Path) -> JournalContent:
    """Return the content of a file as far as it is readable. Raises JournalError if it is not a journal."""
    return read_content(_bytes(file), file.name)


def read_lines(file: Path) -> list[bytes]:
    """Return the lines of a file's entries, the first at the header's position.

    Raises JournalError for any other file.
    """
    data = _bytes(file)
    end = _header_end(data)
    read_header(data[:end], file.name)
    return [line for text, _ in unpack(data, end) for line in text.split(b"\n")[:-1]]


def read_content(data: bytes, name: str) -> JournalContent:
    """Return the content of these bytes of a file. Raises JournalError if they are not a journal."""
    end = _header_end(data)
    header = read_header(data[:end], name)
    entries, read = list[RecordedEntry](), end
    try:
        for text, until in unpack(data, end):
            read = until
            for line in text.split(b"\n")[:-1]:
                entries.append(entry_of(line, header.first + len(entries)))
    except JournalError:
        return JournalContent(header, tuple(entries), whole=False)
    return JournalContent(header, tuple(entries), whole=read == len(data))


def each_entry(file: Path) -> Iterator[RecordedEntry]:
    """Yield the entries of `read_journal` one by one: a file of a busy day is large once it is unpacked.

    Raises JournalError if the file is not a journal.
    """
    data = _bytes(file)
    end = _header_end(data)
    position = read_header(data[:end], file.name).first
    with suppress(JournalError):
        for text, _ in unpack(data, end):
            for line in text.split(b"\n")[:-1]:
                yield entry_of(line, position)
                position += 1


def line_of(entry: RecordedEntry) -> bytes:
    """Return an entry as a line of a frame. Raises TypeError, ValueError or RecursionError if it is not JSON data."""
    return encode(entry_data(entry)).encode("utf-8", "surrogatepass") + b"\n"


def _header_end(data: bytes) -> int:
    return data.find(b"\n", 0, MAX_HEADER_BYTES) + 1


def _bytes(file: Path) -> bytes:
    try:
        return read_regular(file, MAX_FILE_BYTES, follow=False)
    except OSError as error:
        raise JournalError(f"{file} can't be read: {error.strerror or error}") from None


def entry_of(line: bytes, position: int) -> RecordedEntry:
    """Return the entry in a line of a frame, with its position. Raises JournalError if the line has no entry."""
    return read_entry(_decoded(line), position)


def _decoded(line: bytes) -> Any:
    """Return the data in a line, `{}` if it is not JSON.

    orjson is fast, but reads neither NaN nor lone surrogates, which `json` does.
    """
    with suppress(ValueError):
        return orjson.loads(line)
    try:
        return json.loads(line.decode("utf-8", "surrogatepass"))
    except (ValueError, RecursionError):
        return {}
