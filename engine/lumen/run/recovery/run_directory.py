"""What a run has in the home of its project: the door to its bus, its records, and what the run before left there."""

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

_log = logging.getLogger(__name__)


class RunDirectory:
    """Takes the home of the project in `root`, or of its `robot`, for this run.

    `home` is None where another run has it, or none can be. A process without a brain is a guest: it leaves the home to
    the one that has it. `news` are the reloads that this start was, to be told as soon as somebody can hear it.
    """

    def __init__(self, root: Path, robot: str = "", *, guest: bool = False) -> None:
        self.root, self.robot, self.taken = root, robot, False
        self.home: Home | None = None
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
        self._ended = False
        self.news: list[ReloadReport] = []
        self._door: LocalBusServer | None = None
        self._bus = ""

    def begin(self, project: Project, files: Mapping[str, bytes]) -> None:
        """The exhibition starts on these files; where none have proved themselves yet, they are the last good ones."""
        if keeper := self.records.keeper:
            kept, good = keeper.kept(), keeper.good()
            keeper.store(files)
            if not good:
                keeper.approve(project.hash)
            keeper.prune(project.hash, good, kept.bundle if kept else "")

    def ended(self, project: Project) -> None:
        """The exhibition has ended as it should, on these files."""
        self._ended = True
        self.records.annul()
        if not self.records.died(project.hash):
            self.records.approve(project.hash)

    @property
    def refused(self) -> str:
        """The hash of the files that are there, where this start has taken others."""
        return next((report.after for report in self.news if report.verdict == "refused"), "")

    def reloader(
        self,
        behavior: LiveBehavior,
        narrator: Narrator,
        options: ReloadOptions,
        *,
        wake: Callable[[], None] = lambda: None,
    ) -> Reloader:
        """Return the reloader of this run, which judges saved files in another process; `wake` as it says there."""
        options = replace(options, seen=self.refused)
        return Reloader(behavior, narrator, options, records=self.records, applied=self.announce, wake=wake)

    def begin_run(
        self, behavior: LiveBehavior, url: str, reloader: Reloader | None, *, fresh: bool
    ) -> Resumption | FreshStart:
        """Let others find this run, and tell what was reloaded; how it goes on with the run before, or begins.

        One that begins `fresh` asks for nothing but whether the robot was at rest.
        """
        self.open(behavior.loop.bus, url, behavior.project)
        found = rested(self.records) if fresh else self.resumption(behavior.project)
        if reloader:
            reloader.begin(self.news)
        return found

    def open(self, bus: Bus, url: str, project: Project) -> None:
        """Let others find this run: by its broker, or through a door to the embedded bus."""
        self._bus = url
        if self.home and within_process(url):
            try:
                self._door = LocalBusServer(bus, self.home.folder)
            except OSError as error:
                _log.warning("the exhibition can't be reached from other terminals: %s", error)
                return
        self.announce(project)

    def announce(self, project: Project) -> None:
        """Say where this run is found, and under which key its robot takes commands."""
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
        """Give it back; `forget` where the run has ended as it should, and there is nothing to go on with."""
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
        """The bundle that ran last and was good, None where none was kept.

        It was judged, and so were the files that are there now: none of that is read in this process.
        """
        keeper = self.records.keeper
        files = keeper.files(keeper.good()) if keeper else None
        return load_apart(self.root, as_robot(files, self.robot))[0] if files else None

    def resumption(self, project: Project) -> Resumption | FreshStart:
        """How the run before is gone on with under this project, or why it is not."""
        found = recover(self.root, self.records, project)
        self.news += found.news
        return found.how
