"""The visits of a journal from the newest to the oldest; files are read only when their visits are used."""

from collections.abc import Iterator, Sequence
from contextlib import suppress
from itertools import islice
from pathlib import Path

from lumen.errors import JournalError
from lumen.insight.replay.entries import JournalJump, RecordedEntry
from lumen.insight.replay.visits import RecordedVisit, visits
from lumen.journal.journal_file import read_journal
from lumen.run.replaying.journals import KeptBundles
from lumen.run.replaying.other_files import with_machines


def latest_first(files: Sequence[Path], bundles: KeptBundles) -> Iterator[RecordedVisit]:
    """Yield the visits in these files of one journal, the newest first; an unreadable file has none.

    The files are given in order. A visit that continues in the next file is completed from that file, and belongs to
    the file in which it begins.
    """
    for number in reversed(range(len(files))):
        entries = _entries(files[number])
        found = list(visits(with_machines(entries, bundles)))
        if found and not found[-1].whole and number + 1 < len(files):
            both = visits(with_machines([*entries, *_entries(files[number + 1])], bundles))
            found = list(islice(both, len(found)))
        if number and found and _goes_on(entries, found[0]):
            del found[0]
        yield from reversed(found)


def _entries(file: Path) -> tuple[RecordedEntry, ...]:
    with suppress(JournalError):
        return read_journal(file).entries
    return ()


def _goes_on(entries: Sequence[RecordedEntry], visit: RecordedVisit) -> bool:
    """Return whether a visit began in the previous file: it then begins at the keyframe that begins this file."""
    first = entries[0]
    return isinstance(first, JournalJump) and first.kind == "keyframe" and visit.first == first.position
