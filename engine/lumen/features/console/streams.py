"""Server-sent events: each page receives robots, entries and commands once and in order."""

import time
from collections.abc import AsyncIterator, Mapping
from dataclasses import dataclass
from typing import NamedTuple

from lumen.errors import BusError
from lumen.features.console.entry_ring import EncodedEntry
from lumen.features.console.known_robot import KnownRobot
from lumen.features.console.watch import Watch

HEARTBEAT = 1.0
"""A page receives at least a comment this often [s]."""
NOW_PERIOD = 0.25
"""The shortest time between two `now` events of a robot [s]."""
RECENT = 200
"""A page without a position first receives at most this many of the latest entries, only those with a text."""
FRESH = -2
"""The position of a page that has no entries."""
AGAIN = 500
"""The pause of a browser before it reconnects [ms]."""


@dataclass
class ReadPosition:
    """The positions up to which a page has received the journal and the state of one robot."""

    position: int
    """The position of the last entry that the page has."""
    run: int
    """The `run` of the ring with that entry, -1 if unknown."""
    version: int = -1
    """The version of the robot that the page has, -1 for none."""
    at: float = 0.0
    """The time at which that version was sent [s, monotonic]."""


class Listener(NamedTuple):
    """A page that receives events."""

    robot: str
    """The robot that the page shows; empty for all."""
    after: Mapping[str, int]
    """The last position that the page has, by robot; `""` applies to any robot."""
    full: bool
    """True if the page has a role and receives everything."""
    once: bool
    """True if the stream ends after the events that exist now."""


def positions_in(text: str, robot: str) -> dict[str, int]:
    """Return the positions in `Last-Event-ID` or `?after=`: `12` for that robot (empty: any), or `NAO:12,NAO2:5`."""
    found = {}
    for part in text.split(","):
        name, _, number = part.strip().rpartition(":")
        if number.removeprefix("-").isdigit() and len(number) < 19:
            found[name or robot] = int(number)
    return found


class Streams:
    """Makes the streams of all pages from one watch; `close` ends them."""

    def __init__(self, watch: Watch) -> None:
        self._watch, self.closing = watch, False
        self.commands: list[tuple[int, bytes]] = []

    def close(self) -> None:
        self.closing = True
        self._watch.changes.tell()

    async def events(self, who: Listener) -> AsyncIterator[bytes]:
        """Yield the events of one page until the page or the console closes, or for one round if `once` is set."""
        cursors: dict[str, ReadPosition] = {}
        command = self.commands[-1][0] if self.commands else 0
        self._watch.lookers += 1
        beaten = time.monotonic()
        yield b"retry: %d\n: the console of Lumen\n\n" % AGAIN
        try:
            while not self.closing:
                seen = self._watch.changes.count
                for view in self._views(who):
                    cursor = self._cursor(cursors, view, who)
                    if who.full:
                        async for entry in self._entries(view, cursor):
                            yield self._block(who, view, entry, cursors)
                    now = time.monotonic()
                    if cursor.version != view.version and now - cursor.at >= NOW_PERIOD:
                        cursor.version, cursor.at = view.version, now
                        yield view.block(full=who.full)
                for number, block in self.commands:
                    if number > command and who.full:
                        command = number
                        yield block
                if who.once:
                    return
                pending = any(cursors[v.robot].version != v.version for v in self._views(who) if v.robot in cursors)
                wait = NOW_PERIOD if pending else max(0.01, beaten + HEARTBEAT - time.monotonic())
                await self._watch.changes.wait(seen, wait)
                if time.monotonic() - beaten >= HEARTBEAT:
                    beaten = time.monotonic()
                    yield b":\n\n"
        finally:
            self._watch.lookers -= 1

    def tell(self, block: bytes) -> None:
        """Send an event about a command to all pages that have a role."""
        number = self.commands[-1][0] + 1 if self.commands else 1
        self.commands = [*self.commands[-49:], (number, block)]
        self._watch.changes.tell()

    def _views(self, who: Listener) -> list[KnownRobot]:
        return [view for name, view in self._watch.robots.items() if not who.robot or name == who.robot]

    def _cursor(self, cursors: dict[str, ReadPosition], view: KnownRobot, who: Listener) -> ReadPosition:
        entries = view.entries
        if (cursor := cursors.get(view.robot)) is None:
            cursor = cursors[view.robot] = ReadPosition(who.after.get(view.robot, who.after.get("", FRESH)), -1)
        if cursor.run < 0 and entries.known:
            cursor.run = entries.run
            newest = max(entries.last, view.position or cursor.position)
            if cursor.position > max(newest, FRESH):  # of a journal that is gone
                cursor.position = entries.first
        elif cursor.run >= 0 and cursor.run != entries.run:
            cursor.run, cursor.position = entries.run, entries.first
        return cursor

    async def _entries(self, view: KnownRobot, cursor: ReadPosition) -> AsyncIterator[EncodedEntry]:
        """Yield the new entries of a robot's journal: from the ring, or from its exhibition if they are older."""
        while cursor.run >= 0 and not self.closing:
            entries = view.entries
            found = entries.recent(RECENT) if cursor.position == FRESH else entries.after(cursor.position)
            if found is None:
                try:
                    page = await self._watch.page(view.robot, cursor.position + 1)
                except BusError:
                    return
                found = [one for one in view.entries.encoded(page) if one.position > cursor.position]
                if not found:
                    cursor.position = view.entries.first
                    continue
            for entry in found:
                cursor.position = entry.position
                yield entry
            if not found or cursor.position >= view.entries.last:
                return

    def _block(
        self, who: Listener, view: KnownRobot, entry: EncodedEntry, cursors: Mapping[str, ReadPosition]
    ) -> bytes:
        if who.robot or len(self._watch.robots) == 1:
            id = str(entry.position)
        else:
            id = ",".join(f"{name}:{one.position}" for name, one in cursors.items() if one.run >= 0)
        return b"event: entry\nid: " + id.encode() + b"\ndata: " + entry.data + b"\n\n"
