"""Removes a visitor's name from a file of the journal; the changed entries are marked."""

import os
from collections.abc import Iterable, Iterator
from pathlib import Path

from lumen.errors import JournalError, ModuleError
from lumen.insight.replay.entries import JournalInput, JournalJump, RecordedEntry, entry_data
from lumen.journal.forgotten_snapshots import forgetful_data
from lumen.journal.journal_file import FramePacker, JournalContent, line_of, read_journal
from lumen.language.people import PersonName

LINES_PER_FRAME = 1000


def redact(file: Path, person: PersonName) -> int:
    """Remove a visitor's name from a file, which is replaced as a whole; return how many entries named the visitor.

    Unreadable content is deleted, because it may hold the name; a file that is unreadable as a whole counts as one
    entry, unless it is empty. The file keeps its time, so it is not kept longer. Raises ModuleError if the file can't
    be replaced or deleted.
    """
    try:
        content = read_journal(file)
    except JournalError:
        return 0 if _emptied(file) else 1
    named = sum(names(entry, person) for entry in content.entries)
    if named or not content.whole:
        draft = file.with_name(f"{file.name}.{os.getpid()}.new")
        try:
            with open(os.open(draft, os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o600), "wb") as written:
                written.writelines(_packed(content, person))
            was = file.stat()
            os.utime(draft, ns=(was.st_atime_ns, was.st_mtime_ns))
            os.replace(draft, file)
        except OSError as error:
            raise ModuleError(f"{file} can't be written: {error.strerror}") from None
    return named


def names(entry: RecordedEntry, person: PersonName) -> bool:
    """Return True if an entry contains the name of that person."""
    return person.is_in(entry_data(entry))


def redacted(entries: Iterable[RecordedEntry], person: PersonName, *, within: bool = False) -> Iterator[RecordedEntry]:
    """Yield the entries without the name.

    From the first entry with the name, or from the beginning if `within`, until a keyframe without the name, no digest
    is kept: names could be guessed by comparing digests.
    """
    for entry in entries:
        found = names(entry, person)
        within = found or (within and not (isinstance(entry, JournalJump) and entry.snapshot is not None))
        yield _without(entry, person) if within else entry


def _without(entry: RecordedEntry, person: PersonName) -> RecordedEntry:
    commands = tuple(person.scrubbed(command) for command in entry.commands)
    if isinstance(entry, JournalInput):
        event = entry.event._replace(data=person.scrubbed(entry.event.data), name=person.scrubbed(entry.event.name))
        cause = event.cause and event.cause._replace(sender=person.scrubbed(event.cause.sender))
        return entry._replace(event=event._replace(cause=cause), commands=commands, digest="", redacted=True)
    snapshot = entry.snapshot and forgetful_data(entry.snapshot, person)
    if snapshot and person.is_in(snapshot):
        snapshot = None
    return entry._replace(snapshot=snapshot, commands=commands, said=person.scrubbed(entry.said), redacted=True)


def _packed(content: JournalContent, person: PersonName) -> Iterator[bytes]:
    packer = FramePacker()
    yield content.header.line()
    lines = [line_of(entry) for entry in redacted(content.entries, person)]
    for at in range(0, len(lines), LINES_PER_FRAME):
        yield packer.pack(b"".join(lines[at : at + LINES_PER_FRAME]))


def _emptied(file: Path) -> bool:
    """Delete a file; return True if it was empty."""
    try:
        size = file.stat().st_size
        file.unlink()
    except OSError as error:
        raise ModuleError(f"{file} can't be read or deleted: {error.strerror}") from None
    return size == 0
