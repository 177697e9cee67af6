"""The files that a running exhibition writes in its home: journal, bundles, and the behaviour's snapshot."""

import json
import logging
import time
from collections.abc import Mapping
from concurrent.futures import Future, ThreadPoolExecutor
from functools import partial
from typing import Any

from lumen.journal.journal_writer import JournalWriter
from lumen.language.people import PersonName
from lumen.language.projects import Project
from lumen.project.crash_counter import CrashCounter
from lumen.project.home import Home
from lumen.run.loop import BehaviorLoop
from lumen.run.reload_journal import Journal
from lumen.run.snapshot_store import SnapshotStore

HEARTBEAT_PERIOD = 1.0
"""The time between two marks that the run is alive, if nothing else is written [s]."""

DECISIONS_FILE = "decisions.json"

_log = logging.getLogger(__name__)


class RunRecords:
    """The records in a home; without a home nothing is written, because another run of the project holds it.

    Snapshots are written many times a second, and a disk may block for half a second, so a thread writes them until
    `close`.
    """

    def __init__(self, home: Home | None) -> None:
        self._told, self._failed, self._trial = False, False, ""
        self._desk = ThreadPoolExecutor(1, "records")
        self._keeping: Future[None] | None = None
        self._beaten = 0.0
        self._home = home
        self.keeper = SnapshotStore(home) if home else None
        self.trials = CrashCounter(home) if home else None
        self.journal = Journal(home.folder if home else None)
        self.inputs: JournalWriter | None = None

    @property
    def trouble(self) -> str:
        """Why the snapshot of the behaviour or the journal can't be written; empty if both can."""
        if why := self.keeper.trouble if self.keeper else "":
            return f"the snapshot of the behaviour can't be written: {why}"
        return self.inputs.trouble if self.inputs else ""

    def write(self, entry: Mapping[str, Any]) -> None:
        """Write an entry of the reload journal."""
        self.journal.write(entry)

    def keep_decisions(self, decisions: Mapping[str, Any]) -> None:
        """Save people's decisions and the waiting events on the thread, for a run that resumes after a crash."""
        if self._home:
            self._desk.submit(self._home.write, DECISIONS_FILE, json.dumps(decisions, default=str).encode())

    def decisions(self) -> Any:
        """Return people's decisions at the end of the previous run; None if there are none."""
        return self._home.read_json(DECISIONS_FILE) if self._home else None

    def store(self, files: Mapping[str, bytes]) -> None:
        """Store the files of an accepted bundle."""
        if self.keeper:
            self.keeper.store(files)

    def files(self, hash: str) -> Mapping[str, bytes] | None:
        """Return the files of a stored bundle; None if they are not kept."""
        return self.keeper.files(hash) if self.keeper else None

    def begin(self, hash: str) -> None:
        """Start the trial of a newly active bundle; the end of the previous trial does not count as a crash."""
        self.annul()
        self._trial = hash
        if self.trials:
            self.trials.begin(hash)

    def approve(self, hash: str) -> None:
        """Record that a bundle has passed its probation."""
        if self.keeper and self.trials:
            self.keeper.approve(hash)
            self.trials.acquit(hash)
            self._trial = ""

    def condemn(self) -> None:
        """Record that the bundle on trial failed while the exhibition survived."""
        self._trial = ""

    def died(self, hash: str) -> int:
        """Return how many times the exhibition ended before this bundle passed its probation."""
        return self.trials.count(hash) if self.trials else 0

    def annul(self) -> None:
        """Record that the exhibition ends for reasons other than its files."""
        if self.trials and self._trial:
            self.trials.annul(self._trial)
        self._trial = ""

    def prune(self, *projects: Project | None) -> None:
        """Delete all bundles except these and those that the journal needs."""
        if self.keeper:
            self._desk.submit(self.keeper.prune, *(project.hash for project in projects if project))

    def keep(self, exhibition: BehaviorLoop) -> None:
        """Write the behaviour's snapshot if it is new, else a sign of life if due; do neither while a write runs."""
        snapshot = exhibition.runtime.snapshot
        if self.keeper is None or not self._settled():
            return
        if self.keeper.due(snapshot):
            on, keep = tuple(exhibition.tracking.on), partial(self.keeper.keep, rests=exhibition.rests)
            self._keeping = self._desk.submit(keep, exhibition.project, snapshot, on)
        elif time.monotonic() - self._beaten >= HEARTBEAT_PERIOD:
            self._beaten = time.monotonic()
            self._keeping = self._desk.submit(self.keeper.beat)

    def forget(self, person: PersonName) -> None:
        """Remove a person's entries from the journals; `keep` writes the snapshot anew."""
        if self._home:
            self._desk.submit(self.journal.forget, person)
        if self.inputs:
            self.inputs.forget(person)

    def close_inputs(self) -> None:
        """Write the rest of the journal of inputs."""
        if self.inputs:
            self.inputs.close()

    def close(self) -> None:
        """Wait for the current writes; nothing is written afterwards."""
        self.close_inputs()
        self._desk.shutdown()
        self._settled()

    def _settled(self) -> bool:
        """Return whether nothing is being written; log a failed write once."""
        if self._keeping and not self._keeping.done():
            return False
        if self._keeping and (fault := self._keeping.exception()):
            self._keeping = None
            if not self._failed:
                _log.error("the snapshot of the behaviour could not be kept", exc_info=fault)
            self._failed = True
        if self.keeper and self.keeper.trouble and not self._told:
            self._told = True
            _log.warning("the snapshot of the behaviour can't be kept: %s", self.keeper.trouble)
        return True
