"""Removes a person from a recording: their name, and all pictures and sounds from around the time of each mention."""

import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

import orjson

from lumen.features.mcap.files.encoding import json_bytes
from lumen.features.mcap.files.foxglove import NANO
from lumen.features.mcap.files.reading import read_recording
from lumen.features.mcap.files.recorded import Recorded, RecordedFile, RecordedMessage
from lumen.features.mcap.files.rewriting import Changed
from lumen.journal.journal_file import JOURNAL_SUFFIX
from lumen.journal.redaction import redact
from lumen.language.people import PersonName

AROUND = 600.0
"""The time before and after a person's name in which pictures and sounds are removed [s]."""
PICTURE_FORM = "foxglove.CompressedImage"
SOUND_FORMS = ("lumen.recording", "lumen.wav.stream")


class Redaction(NamedTuple):
    """The numbers of items in a recording that name a person or may show them."""

    messages: int = 0
    """The number of messages that name the person."""
    files: int = 0
    """The number of attached files that name the person."""
    pictures: int = 0
    """The number of pictures and sounds that can contain the person."""

    def __bool__(self) -> bool:
        return any(self)


def redacted(path: Path, person: PersonName) -> tuple[Redaction, Changed]:
    """Return the number of items about a person in a recording, and the function that removes them.

    Raises RecordingError if the file is not a recording.
    """
    times, messages, files = list[int](), 0, 0
    for item in read_recording(path):
        match item:
            case RecordedMessage() if person.is_in(_data(item)):
                messages += 1
                times.append(item.came)
            case RecordedFile() if _without_person(item, person) is not item:
                files += 1
    spans = _merged(times)

    def shown(item: Recorded) -> bool:
        return isinstance(item, RecordedMessage) and _shows(item) and any(a <= item.came <= b for a, b in spans)

    pictures = sum(map(shown, read_recording(path))) if spans else 0

    def changed(item: Recorded) -> Recorded | None:
        if shown(item):
            return None
        match item:
            case RecordedMessage() if person.is_in(data := _data(item)):
                return item._replace(data=json_bytes(person.scrubbed(data)))
            case RecordedFile():
                return _without_person(item, person)
            case _:
                return item

    return Redaction(messages, files, pictures), changed


def _shows(item: RecordedMessage) -> bool:
    return item.channel.form == PICTURE_FORM or item.channel.form in SOUND_FORMS


def _data(item: RecordedMessage) -> Any:
    if item.channel.encoding != "json":
        return None
    try:
        found = orjson.loads(item.data)
    except ValueError:
        return item.data.decode("utf-8", "replace")
    return found if isinstance(found, Mapping) else {"value": found}


def _without_person(item: RecordedFile, person: PersonName) -> RecordedFile:
    """Return an attached journal without the name; the item itself if it is not a journal or lacks the name."""
    if not item.name.endswith(JOURNAL_SUFFIX):
        return item
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / Path(item.name).name
        file.write_bytes(item.data)
        if not redact(file, person):
            return item
        return item._replace(data=file.read_bytes() if file.exists() else b"")


def _merged(times: list[int]) -> list[tuple[int, int]]:
    """Return the spans from AROUND before to AROUND after these times [ns since 1970]; merge overlapping spans."""
    spans = list[tuple[int, int]]()
    around = int(AROUND * NANO)
    for at in sorted(times):
        if spans and at - around <= spans[-1][1]:
            spans[-1] = spans[-1][0], at + around
        else:
            spans.append((at - around, at + around))
    return spans
