"""Entries of the journal from a position on, for who asks on the bus: a page at a time."""

from collections.abc import Iterable, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

from lumen.errors import JournalError
from lumen.insight.replay.entries import entry_data
from lumen.insight.replay.journal_clock import JournalClock
from lumen.journal.journal_file import entry_of, read_lines
from lumen.journal.journal_folder import headers
from lumen.journal.journal_tail import PositionedLine
from lumen.journal.journal_writer import JournalWriter

MAX_ENTRIES = 500
"""On one page."""
MAX_PAGE_BYTES = 500_000
"""Of their lines; one that is longer is a page of its own."""
PATIENCE = 5.0
"""How long a journal that begins may take to find its first position [s]."""


def journal_page(writer: JournalWriter, position: int, most: int = MAX_ENTRIES) -> dict[str, Any]:
    """Up to `most` entries of the journal that is being written, those from `position` on; `next` is where to go on.

    Each is the JSON data of its entry, with its `position`. The last ones come from memory, older ones from the files.
    What is not kept any more is left out: the first position on the page may be a later one. `run` is the run that
    writes now: in another one, what a power cut took may have its position once more, so `next` is never later than
    what comes next. `epoch` is when the exhibition's time 0 was before the first of them [s since 1970], None where
    that is not kept: entries tell their time from there.
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
    return {"entries": entries, "next": following, "run": writer.run, "epoch": _epoch_after(before)}


def _kept(folder: Path, position: int, most: int) -> tuple[list[bytes], list[PositionedLine]]:
    """Lines of a file before that position, and those from there on; what can't be read is left out."""
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


def _epoch_after(lines: Sequence[bytes]) -> float | None:
    """When time 0 was after these entries: the last of them that says so does."""
    clock = JournalClock()
    for line in reversed(lines):
        if b'"epoch"' in line:
            with suppress(JournalError):
                clock.of(entry_of(line, 0))
        if clock.epoch:
            return clock.epoch
    return None


def _fitting(lines: Iterable[PositionedLine]) -> list[PositionedLine]:
    """The first ones, as many as fit on a page."""
    found, size = list[PositionedLine](), 0
    for line in lines:
        size += len(line[1])
        if found and size > MAX_PAGE_BYTES:
            break
        found.append(line)
    return found
