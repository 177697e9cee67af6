"""The files of a journal of inputs, in a folder in the order of their positions, and its last entries in memory."""

import os
import threading
from collections import deque
from collections.abc import Iterator, Sequence
from contextlib import suppress
from itertools import islice
from pathlib import Path
from typing import BinaryIO

from lumen.errors import JournalError
from lumen.insight.replay.journal_clock import JournalClock
from lumen.journal.journal_file import JOURNAL_SUFFIX, JournalHeader, entry_of, header_of, line_of, read_journal
from lumen.journal.redaction import redacted
from lumen.language.iso_time import file_stamp
from lumen.language.people import PersonName
from lumen.upkeep.own_folders import NO_LINK, private_folder

JOURNAL_FOLDER = "journal"
REHEARSED_FOLDER = "rehearsed"
"""The subfolder for runs of stories and programs, which must not displace visits."""
DAY = 86400.0
MEGABYTE = 1_000_000


class JournalFolder:
    """The files of a journal, kept for `keep` days and up to `size` MB in total; the newest always stays."""

    def __init__(self, folder: Path, keep: float, size: float) -> None:
        self.folder, self._keep, self._size = folder, keep, size

    def files(self) -> list[Path]:
        """Return the files, the oldest first."""
        return sorted(self.folder.glob(f"*{JOURNAL_SUFFIX}"))

    def next_position(self) -> int:
        """Return the position after the last entry that can be read; 0 without such an entry."""
        for file in reversed(self.files()):
            try:
                content = read_journal(file)
            except JournalError:
                continue
            return content.header.first + len(content.entries)
        return 0

    def open(self, header: JournalHeader) -> BinaryIO:
        """Create and return a file with this header; it replaces a file of this run without entries. Raises OSError."""
        private_folder(self.folder)
        name = f"{header.first:012d}-{file_stamp(header.began)}-{header.run[:8]}{JOURNAL_SUFFIX}"
        handle = os.open(self.folder / name, os.O_WRONLY | os.O_CREAT | os.O_TRUNC | os.O_APPEND | NO_LINK, 0o600)
        file = open(handle, "wb", buffering=0)  # noqa: SIM115  the writer closes it
        file.write(header.line())
        return file

    def prune(self, now: float) -> None:
        """Delete files that are older than the limit, and the oldest ones beyond the size limit; keep the newest."""
        left = 0
        for number, file in enumerate(reversed(self.files())):
            with suppress(OSError):
                said = file.stat()
                left += said.st_size
                if number and (now - said.st_mtime > self._keep * DAY or left > self._size * MEGABYTE):
                    file.unlink()

    def clear(self) -> None:
        """Delete all files."""
        for file in self.files():
            with suppress(OSError):
                file.unlink()


def newest(home: Path) -> Path | None:
    """Return the journal file that a run with this home writes, or wrote last; None without such a file."""
    return max((home / JOURNAL_FOLDER).glob(f"*{JOURNAL_SUFFIX}"), default=None)


def named_bundles(home: Path) -> set[str]:
    """Return the hashes of the bundles that the journals of a home need; unreadable files need none."""
    return {header.bundle for _, header in headers(home / JOURNAL_FOLDER)}


def headers(folder: Path) -> Iterator[tuple[Path, JournalHeader]]:
    """Yield each file of a journal, rehearsals in its subfolder included, with its header; skip unreadable files."""
    for file in sorted(folder.rglob(f"*{JOURNAL_SUFFIX}")):
        with suppress(JournalError):
            yield file, header_of(file)


MAX_ENTRIES = 2_000
MAX_BYTES = 4_000_000
"""The greatest total size of the lines in memory [bytes]; MAX_ENTRIES is their greatest number."""

PositionedLine = tuple[int, bytes]
"""The position of an entry, and its line of JSON."""


def epoch_after(lines: Sequence[bytes]) -> float | None:
    """Return the date of time 0 that these entries recorded last [s since 1970], else None."""
    clock = JournalClock()
    for line in reversed([line for line in lines if b'"epoch"' in line]):
        with suppress(JournalError):
            clock.of(entry_of(line, 0))
        if clock.epoch:
            return clock.epoch
    return None


class JournalTail:
    """The lines of the last entries of a run, whether or not they are on the disk; any thread may read them.

    Positions are those of the journal; an entry that the disk refused has one, too.
    """

    def __init__(self, most: int = MAX_ENTRIES, most_bytes: int = MAX_BYTES) -> None:
        self._most, self._most_bytes = most, most_bytes
        self._lines: deque[bytes] = deque()
        self._size, self._next = 0, 0
        self._lock = threading.Lock()
        self.epoch: float | None = None
        """The exhibition's time 0 before the oldest entry in memory [s since 1970]; None before it is known."""

    @property
    def next(self) -> int:
        """The position of the next entry."""
        return self._next

    @property
    def first(self) -> int:
        """The position of the oldest entry in memory; `next` if there are no entries."""
        with self._lock:
            return self._next - len(self._lines)

    def begin(self, position: int) -> None:
        """Set the position of the first entry."""
        self._next = position

    def add(self, lines: Sequence[bytes]) -> None:
        with self._lock:
            self._lines += lines
            self._next += len(lines)
            self._size += sum(map(len, lines))
            while len(self._lines) > self._most or self._size > self._most_bytes:
                self._size -= len(gone := self._lines.popleft())
                self.epoch = epoch_after([gone]) or self.epoch

    def since(self, position: int, most: int) -> list[PositionedLine]:
        """Return up to `most` entries from `position` on, or from the oldest in memory if the entry there is gone."""
        with self._lock:
            first = self._next - len(self._lines)
            begin = max(position - first, 0)
            return list(enumerate(islice(self._lines, begin, begin + most), first + begin))

    def forget(self, person: PersonName) -> None:
        """Remove a visitor's name. Call it on the thread that adds entries.

        Earlier entries may have named the visitor, so no digest is kept until a keyframe without the name.
        """
        entries = [entry_of(line, position) for position, line in self.since(0, self._most)]
        lines = [line_of(entry) for entry in redacted(entries, person, within=True)]
        with self._lock:
            self._lines, self._size = deque(lines), sum(map(len, lines))
