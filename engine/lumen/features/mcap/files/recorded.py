"""The items of a recording as values: channels, messages, attachments and metadata."""

from typing import NamedTuple


class RecordedChannel(NamedTuple):
    """A channel: the messages of one topic with one schema."""

    topic: str
    encoding: str
    """The encoding of the messages' data: `json` or `protobuf`."""
    form: str
    """The name of the schema."""
    language: str
    """The language of the schema: `jsonschema` or `protobuf`."""
    schema: bytes
    """The encoded schema."""


class RecordedMessage(NamedTuple):
    """A recorded message, with the times of its arrival and its sending [ns since 1970, in UTC]."""

    channel: RecordedChannel
    came: int
    sent: int
    data: bytes


class RecordedFile(NamedTuple):
    """An attached file that explains a recording; `at` is its time [ns since 1970, in UTC]."""

    name: str
    kind: str
    data: bytes
    at: int


class RecordedNotes(NamedTuple):
    """Named metadata of a recording."""

    name: str
    words: tuple[tuple[str, str], ...]


Recorded = RecordedMessage | RecordedFile | RecordedNotes
