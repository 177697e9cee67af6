"""A file of the journal without somebody: what names them is taken out in place, and marked."""

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
    """Take somebody's name out of a file, which is replaced as a whole; how many entries named them.

    What can't be read is deleted: nobody can say whom it names. The file stays as old as it was, and is not kept
    longer. Raises ModuleError where it can't be written anew.
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
    """Whether an entry says the name of that person."""
    return person.is_in(entry_data(entry))


def redacted(entries: Iterable[RecordedEntry], person: PersonName, *, within: bool = False) -> Iterator[RecordedEntry]:
    """The entries without the name. From the first that said it on no digest is kept, which somebody might try names
    against, until a keyframe that does not say it; from the beginning on where it was `within` what came before.
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
    """Whether a file held nothing; it is deleted in any case."""
    try:
        size = file.stat().st_size
        file.unlink()
    except OSError as error:
        raise ModuleError(f"{file} can't be read or deleted: {error.strerror}") from None
    return size == 0
