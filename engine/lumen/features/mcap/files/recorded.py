"""What a recording holds, as values: channels, messages, attachments and metadata."""

from typing import NamedTuple


class RecordedChannel(NamedTuple):
    """Messages of one topic in one form; `encoding` is that of their data, `json` or `protobuf`.

    `form` is the schema's name, `schema` its data, of the kind `language` (`jsonschema` or `protobuf`).
    """

    topic: str
    encoding: str
    form: str
    language: str
    schema: bytes


class RecordedMessage(NamedTuple):
    """A message as it is written: when it came and when it was sent [ns since 1970, in UTC]."""

    channel: RecordedChannel
    came: int
    sent: int
    data: bytes


class RecordedFile(NamedTuple):
    """A file that is attached, so that a recording explains itself; `at` [ns since 1970, in UTC]."""

    name: str
    kind: str
    data: bytes
    at: int


class RecordedNotes(NamedTuple):
    """Words about a recording, under a name."""

    name: str
    words: tuple[tuple[str, str], ...]


Recorded = RecordedMessage | RecordedFile | RecordedNotes
