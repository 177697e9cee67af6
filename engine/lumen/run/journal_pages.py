"""Pages of the journal from a position on, for requests on the bus."""

from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path
from typing import Any

from lumen.errors import JournalError
from lumen.insight.replay.entries import entry_data
from lumen.journal.journal_file import entry_of, read_lines
from lumen.journal.journal_folder import PositionedLine, epoch_after, headers
from lumen.journal.journal_writer import JournalWriter

MAX_ENTRIES = 500
"""The greatest number of entries on one page."""
MAX_PAGE_BYTES = 500_000
"""The greatest size of a page's lines [bytes]; a longer line gets a page of its own."""
PATIENCE = 5.0
"""The longest wait until a new journal knows its first position [s]."""


def journal_page(writer: JournalWriter, position: int, most: int = MAX_ENTRIES) -> dict[str, Any]:
    """Return up to `most` entries, from `position` on, of the journal that is being written.

    `entries` are the JSON data of each entry, with its `position`: the newest from memory, older ones from the files.
    Entries that are no longer kept are left out, so the first position may be a later one. `next` is the position of
    the next page. `run` identifies the current run: after a power cut, another run may reuse the positions of lost
    entries, so `next` never exceeds the next position to be written. `epoch` is the date of the exhibition's time 0
    before the first entry [s since 1970], None if unknown; the entries' times count from there.
    """
    if not writer.begun.wait(PATIENCE):
        return {"entries": [], "next": position, "run": writer.run, "epoch": None}
    first, lines, before = writer.tail.first, list[PositionedLine](), list[bytes]()
    if position < first and writer.folder:
        before, lines = _kept(writer.folder.folder, position, most)
    if not lines or lines[0][0] > first:
        before = [line for _, line in writer.tail.since(first, max(position - first, 0))]
        lines = writer.tail.since(position, most)
    lines = _fitting(lines)
    entries = list[dict[str, Any]]()
    for at, line in lines:
        with suppress(JournalError):
            entries.append({"position": at, **entry_data(entry_of(line, at))})
    following = lines[-1][0] + 1 if lines else writer.tail.next
    return {"entries": entries, "next": following, "run": writer.run, "epoch": epoch_after(before) or writer.tail.epoch}


def _kept(folder: Path, position: int, most: int) -> tuple[list[bytes], list[PositionedLine]]:
    """Return a file's lines before `position`, and up to `most` lines from there on; unreadable files are left out."""
    files = sorted((header.first, file) for file, header in headers(folder) if file.parent == folder)
    begin = max((number for number, (first, _) in enumerate(files) if first <= position), default=0)
    before, found = list[bytes](), list[PositionedLine]()
    for first, file in files[begin:]:
        if len(found) >= most:
            break
        try:
            lines = read_lines(file)
        except JournalError:
            continue
        before = before if found else lines[: max(position - first, 0)]
        found += enumerate(lines[max(position - first, 0) :][: most - len(found)], max(position, first))
    return before, found


def _fitting(lines: Iterable[PositionedLine]) -> list[PositionedLine]:
    """Return as many of the first lines as fit on a page, at least one."""
    found, size = list[PositionedLine](), 0
    for line in lines:
        size += len(line[1])
        if found and size > MAX_PAGE_BYTES:
            break
        found.append(line)
    return found
