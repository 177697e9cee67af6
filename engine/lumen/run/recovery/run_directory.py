"""A run's files in the home of its project: the address of its bus, its records, and those of the previous run."""

import logging
import os
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path

from lumen.bus.addresses import within_process
from lumen.bus.local import LocalBusServer
from lumen.errors import UsageError
from lumen.language.projects import Project
from lumen.ports import Bus
from lumen.project.chosen_robot import as_robot
from lumen.project.home import ADDRESS_FILE, Home, home_of
from lumen.robot.robot_routes import COMMAND_ROUTE, STOP_ROUTE
from lumen.run.live_behavior import LiveBehavior
from lumen.run.narrator import Narrator
from lumen.run.parts.kept_hold import forget_hold
from lumen.run.recovery.previous_run import recover, rested
from lumen.run.reload.records import RunRecords
from lumen.run.reload.reloader import Reloader, ReloadOptions
from lumen.run.reload.report import ReloadReport
from lumen.run.reload.validation_worker import load_apart
from lumen.run.resuming import FreshStart, Resumption
from lumen.run.snapshot_store import SnapshotStore

_log = logging.getLogger(__name__)


class RunDirectory:
    """The home of the project in `root`, or of its `robot`, while this run holds it.

    A process without a brain is a `guest`, and leaves the home to the process that has one. `taken` is whether another
    run holds the home.
    """

    def __init__(self, root: Path, robot: str = "", *, guest: bool = False) -> None:
        self.root, self.robot, self.taken = root, robot, False
        self.home: Home | None = None
        """The held home; None if another run holds it or it can't be used."""
        home = Home(home_of(root, robot))
        try:
            if guest:
                pass
            elif home.hold():
                self.home = home
            else:
                self.taken = True
        except UsageError as error:
            _log.warning("the exhibition can't be resumed or reached from other terminals: %s", error)
        self.records = RunRecords(self.home)
        self._files: Mapping[str, bytes] | None = None
        self._ended = False
        self.news: list[ReloadReport] = []
        """Reports on this start as a reload; they are published once the bus is open."""
        self._door: LocalBusServer | None = None
        self._bus = ""

    def begin(self, project: Project, files: Mapping[str, bytes]) -> None:
        """Store the files with which the exhibition starts, and delete stored ones that are no longer needed.

        If there are no last good files yet, these count as the last good ones.
        """
        self._files = files
        if keeper := self.records.keeper:
            kept, good = keeper.kept(), keeper.good()
            keeper.store(files)
            if not good:
                keeper.approve(project.hash)
            keeper.prune(project.hash, good, kept.bundle if kept else "")

    def ended(self, project: Project) -> None:
        """Record that the exhibition ended normally; its files count as good if no crash is recorded for them."""
        self._ended = True
        self.records.annul()
        if not self.records.died(project.hash):
            self.records.approve(project.hash)

    @property
    def refused(self) -> str:
        """The hash of the files on disk if this start used others instead, else empty."""
        return next((report.after for report in self.news if report.verdict == "refused"), "")

    def reloader(
        self,
        behavior: LiveBehavior,
        narrator: Narrator,
        options: ReloadOptions,
        *,
        wake: Callable[[], None] = lambda: None,
    ) -> Reloader:
        """Return the reloader of this run, which checks saved files in another process; `wake` is passed on to it."""
        options = replace(options, seen=self.refused)
        return Reloader(
            behavior, narrator, options, files=self._files, records=self.records, applied=self.announce, wake=wake
        )

    def begin_run(
        self, behavior: LiveBehavior, url: str, reloader: Reloader | None, *, fresh: bool
    ) -> Resumption | FreshStart:
        """Make this run reachable, report this start as a reload, and return how the run continues or begins.

        With `fresh` the previous run is ignored, except that a robot at rest stays at rest.
        """
        self.open(behavior.loop.bus, url, behavior.project)
        found = rested(self.records) if fresh else self.resumption(behavior.project)
        if reloader:
            reloader.begin(self.news)
        return found

    def open(self, bus: Bus, url: str, project: Project) -> None:
        """Make this run reachable: by its broker, or through a local server of the embedded bus."""
        self._bus = url
        if self.home and within_process(url):
            try:
                self._door = LocalBusServer(bus, self.home.folder)
            except OSError as error:
                _log.warning("the exhibition can't be reached from other terminals: %s", error)
                return
        self.announce(project)

    def announce(self, project: Project) -> None:
        """Save the address of this run, and the keys on which its robot receives commands."""
        if self.home is None:
            return
        address = self._door.address if self._door else None
        data = {
            "root": str(self.root.absolute()),
            "process": os.getpid(),
            "bus": self._bus,
            "robot": project.robot,
            "home": self.robot,
            "command": project.key_of(COMMAND_ROUTE),
            "stop": project.key_of(STOP_ROUTE),
            "path": address.path if address else "",
            "port": address.port if address else 0,
            "key": address.key if address else "",
        }
        self.home.write_json(ADDRESS_FILE, data)

    def close(self, *, forget: bool) -> None:
        """Release the home.

        `forget` deletes the snapshot of a run that ended normally and has nothing to resume, and a person's hold.
        """
        if self.home is None:
            return
        self.records.close()
        home, self.home = self.home, None
        if self._door:
            self._door.close()
        home.remove(ADDRESS_FILE)
        if forget and self.records.keeper:
            self.records.keeper.forget()
            forget_hold(home.folder)
        elif self._ended and self.records.keeper:
            self.records.keeper.leave()
        home.release()

    def last_good(self) -> Project | None:
        """Return the last good bundle that ran; None if none was kept.

        A guest reads it in the home of the process that has a brain, even while that process holds the home. The bundle
        is loaded in another process, because files may crash the process that reads them.
        """
        keeper = self.records.keeper or SnapshotStore(Home(home_of(self.root, self.robot)))
        files = keeper.files(keeper.good())
        return load_apart(self.root, as_robot(files, self.robot))[0] if files else None

    def resumption(self, project: Project) -> Resumption | FreshStart:
        """Return how the previous run continues under this project, or why not; add the reports to `news`."""
        found = recover(self.root, self.records, project)
        self.news += found.news
        return found.how
