"""What the console asks of an exhibition's journal, a page at a time."""

from collections.abc import AsyncIterator

import orjson

from lumen.features.console.entry_ring import EncodedEntry
from lumen.features.console.job_promises import MAX_SHOWN
from lumen.features.console.known_robot import KnownRobot
from lumen.features.console.watch import Watch

MAX_REMOTE = 40_000
"""Entries that are asked of an exhibition for its day, the last ones."""


class JournalSource:
    """Entries of the robots of a watch. Everything raises BusError where the exhibition does not answer."""

    def __init__(self, watch: Watch) -> None:
        self._watch = watch

    async def pages(self, robot: str) -> AsyncIterator[bytes]:
        """The last entries of a robot, pages of them as JSON; nothing is kept here."""
        view = self._watch.robots[robot]
        begin, count = max(0, (view.position or view.entries.last) - MAX_REMOTE), 0
        while count < MAX_REMOTE and (page := (await self._watch.page(robot, begin)).entries):
            count += len(page)
            begin = page[-1]["position"] + 1
            yield orjson.dumps(page)

    async def entries(self, view: KnownRobot, first: int, last: int) -> list[EncodedEntry]:
        """The entries of a journal between two positions."""
        found = list[EncodedEntry]()
        while first <= last and len(found) < MAX_SHOWN and (page := await self._watch.page(view.robot, first)).entries:
            found += [one for one in view.entries.encoded(page) if first <= one.position <= last]
            first = page.entries[-1]["position"] + 1
        return found
