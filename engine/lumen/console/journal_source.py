"""Where the console reads days and entries of a journal: from this machine's files, else from the exhibition."""

import threading
from collections.abc import Iterator, Mapping
from datetime import date, datetime
from pathlib import Path
from typing import Any

from lumen.app.replaying.kept_bundles import KeptBundles
from lumen.console.day import Day, day_of
from lumen.console.entry_clock import EntryClock
from lumen.console.entry_ring import EncodedEntry
from lumen.console.known_robot import KnownRobot
from lumen.console.watch import Watch
from lumen.errors import JournalError
from lumen.interpreters.replay.entries import RecordedEntry, read_entry
from lumen.language.machines import MachineDefinition
from lumen.language.projects import Project
from lumen.loading.files import read_files
from lumen.rules import check_files
from lumen.runtime.home import home_of
from lumen.runtime.inputs.journal_file import each_entry
from lumen.runtime.inputs.journal_folder import JOURNAL_FOLDER, headers

MAX_REMOTE = 40_000
"""Entries that are asked of an exhibition for its day, the last ones."""
MAX_SHOWN = 5_000
"""Entries of a visit that a page gets."""
WINDOW = 86_400.0 * 1.5
"""How long before the end of a day a file may have begun that holds something of it [s]."""


class JournalSource:
    """Days of robots: of the project in `root` from its files, where they are here; of others as they tell."""

    def __init__(self, watch: Watch, root: Path) -> None:
        self._watch, self._root = watch, root
        self._kept = KeptBundles(root)
        self._here = list[Project | None]()
        self._reading = threading.Lock()

    async def remote_day(self, robot: str, wanted: date | None) -> Day:
        """The day as the exhibition tells it, from its last entries. Raises BusError where it does not answer."""
        view = self._watch.robots[robot]
        begin = max(0, (view.position or view.entries.last) - MAX_REMOTE)
        found = list[RecordedEntry]()
        while len(found) < MAX_REMOTE and (page := await self._watch.page(robot, begin)):
            found += _recorded(page)
            begin = page[-1]["position"] + 1
        with self._reading:
            return day_of(found, self._machine, wanted)

    def local_day(self, wanted: date | None) -> Day | None:
        """The day from the files of this machine, None where there are none; on a thread."""
        with self._reading:
            files = sorted(self._files(), key=lambda row: row[1])
            if not files:
                return None
            dates = sorted({datetime.fromtimestamp(began).date() for _, _, began in files})
            chosen = wanted or dates[-1]
            end = datetime.combine(chosen, datetime.max.time()).timestamp()
            wanted_files = [file for file, _, began in files if end - WINDOW <= began <= end]
            found = day_of(_entries(wanted_files), self._machine, chosen)
            found.dates = sorted({*dates, *found.dates})
            return found

    def _machine(self, hash: str, behavior: str) -> MachineDefinition | None:
        """What ran then; where that was not kept, what is here now."""
        if kept := self._kept.machine(hash, behavior):
            return kept
        if not self._here:
            self._here = [check_files(self._root, read_files(self._root))[0]]
        project = self._here[0]
        return project.behaviors.get(behavior) if project else None

    def _files(self) -> Iterator[tuple[Path, int, float]]:
        folder = home_of(self._root) / JOURNAL_FOLDER
        for file, header in headers(folder) if folder.is_dir() else ():
            if file.parent == folder:
                yield file, header.first, header.began

    async def entries(self, view: KnownRobot, first: int, last: int) -> list[EncodedEntry]:
        """The entries of a journal between two positions. Raises BusError where the exhibition does not answer."""
        found, clock = list[EncodedEntry](), EntryClock()
        while first <= last and len(found) < MAX_SHOWN and (page := await self._watch.page(view.robot, first)):
            found += view.entries.encoded([one for one in page if one["position"] <= last], clock)
            first = page[-1]["position"] + 1
        return found


def _entries(files: list[Path]) -> Iterator[RecordedEntry]:
    for file in files:
        try:
            yield from each_entry(file)
        except JournalError:
            continue


def _recorded(page: list[Mapping[str, Any]]) -> Iterator[RecordedEntry]:
    for one in page:
        try:
            yield read_entry(one, int(one["position"]))
        except JournalError:
            continue
