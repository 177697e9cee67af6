"""The latest entries of a robot's journal, each encoded once for all pages."""

from bisect import bisect_right
from collections import deque
from collections.abc import Sequence
from itertools import islice
from typing import NamedTuple

import orjson

from lumen.features.console.entry_clock import EntryClock, ToldPage
from lumen.features.console.entry_words import told_of

KEPT = 2_000
"""The maximum number of entries in a ring."""
PAGE = 200
"""The maximum number of entries that `after` returns."""


class EncodedEntry(NamedTuple):
    """An entry at its position, as the data of a server-sent event."""

    position: int
    data: bytes
    has_text: bool
    """False for an entry that no page shows, such as a face without an effect."""


class EntryRing:
    """Consecutive entries of one robot: those after the position `first`, up to `last`.

    `known` is False before the first call of `begin`; `run` counts the later calls, one for each new journal.
    """

    def __init__(self, robot: str) -> None:
        self.robot, self.run = robot, 0
        self.first = self.last = -1
        self.known = False
        self._kept: deque[EncodedEntry] = deque()

    def begin(self, after: int) -> None:
        """Drop all entries, and accept only entries after this position from now on."""
        self.run += self.known
        self.known, self.first, self.last = True, after, after
        self._kept.clear()

    def add(self, page: ToldPage) -> int:
        """Add a page's new entries, drop the oldest beyond KEPT, and return the number of new ones."""
        new = [entry for entry in self.encoded(page) if entry.position > self.last]
        for entry in new:
            self._kept.append(entry)
            self.last = entry.position
        while len(self._kept) > KEPT:
            self.first = self._kept.popleft().position
        return len(new)

    def after(self, position: int) -> Sequence[EncodedEntry] | None:
        """Return up to PAGE entries after a position, the oldest first; None if some of them are no longer kept."""
        if position < self.first:
            return None
        begin = bisect_right(self._kept, position, key=lambda entry: entry.position)
        return list(islice(self._kept, begin, begin + PAGE))

    def recent(self, count: int) -> Sequence[EncodedEntry]:
        """Return the newest entry and, before it, the latest ones with a text: up to `count`, the oldest first."""
        wanted = (entry for entry in reversed(self._kept) if entry.has_text or entry.position == self.last)
        return [*islice(wanted, count)][::-1]

    def encoded(self, page: ToldPage) -> list[EncodedEntry]:
        """Return a page's entries as JSON, each with its robot, time (ISO 8601), line of text and kind added."""
        found, clock = [], EntryClock(page)
        for entry in page.entries:
            words = told_of(entry)
            more = {"robot": self.robot, "at_time": clock.of(entry), **words}
            shown = {key: value for key, value in entry.items() if key != "snapshot"}
            found.append(EncodedEntry(entry["position"], orjson.dumps({**shown, **more}), bool(words["text"])))
        return found
