"""The last entries of a journal in memory: who asks for them again and again waits for no disk."""

import threading
from collections import deque
from collections.abc import Sequence
from itertools import islice

from lumen.journal.journal_file import entry_of, line_of
from lumen.journal.redaction import redacted
from lumen.language.people import PersonName

MAX_ENTRIES = 2_000
MAX_BYTES = 4_000_000
"""Of all their lines together."""

PositionedLine = tuple[int, bytes]
"""The position of an entry, and its line of JSON."""


class JournalTail:
    """The lines of the last entries that a run has made, whether or not a disk took them; any thread may read.

    The positions are those of the journal. One that the disk refused has one, too.
    """

    def __init__(self, most: int = MAX_ENTRIES, most_bytes: int = MAX_BYTES) -> None:
        self._most, self._most_bytes = most, most_bytes
        self._lines: deque[bytes] = deque()
        self._size, self._next = 0, 0
        self._lock = threading.Lock()

    @property
    def next(self) -> int:
        """The position of the entry that comes next."""
        return self._next

    @property
    def first(self) -> int:
        """The position of the oldest entry here; `next` where there is none."""
        with self._lock:
            return self._next - len(self._lines)

    def begin(self, position: int) -> None:
        """The first entry will have this position."""
        self._next = position

    def add(self, lines: Sequence[bytes]) -> None:
        with self._lock:
            self._lines += lines
            self._next += len(lines)
            self._size += sum(map(len, lines))
            while len(self._lines) > self._most or self._size > self._most_bytes:
                self._size -= len(self._lines.popleft())

    def since(self, position: int, most: int) -> list[PositionedLine]:
        """Up to `most` entries, those from `position` on; the oldest here where that is gone."""
        with self._lock:
            first = self._next - len(self._lines)
            begin = max(position - first, 0)
            return list(enumerate(islice(self._lines, begin, begin + most), first + begin))

    def forget(self, person: PersonName) -> None:
        """Take somebody's name out; on the thread that adds.

        Who was named before the first entry here is not known: no digest is kept until a keyframe without the name.
        """
        entries = [entry_of(line, position) for position, line in self.since(0, self._most)]
        lines = [line_of(entry) for entry in redacted(entries, person, within=True)]
        with self._lock:
            self._lines, self._size = deque(lines), sum(map(len, lines))
