"""What a run has in the home of its project: the door to its bus, its records, and what the run before left there."""

import json
import logging
import os
import time
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

from lumen.buses.local import Door
from lumen.cli.reloading.records import Records
from lumen.errors import LumenError, UsageError
from lumen.interpreters.migration import Refusal
from lumen.interpreters.statechart import thaw
from lumen.language.projects import Project
from lumen.ports import Bus
from lumen.robots.orders import command_key
from lumen.rules import check_files
from lumen.runtime.home import DOOR, Home, home_of
from lumen.runtime.keeping import Kept
from lumen.runtime.resuming import Resumption, resume

LATELY = 600.0
"""How old a snapshot may be to be gone on with [s]: after that, whoever spoke with the robot has left."""

_log = logging.getLogger(__name__)


class Premises:
    """Takes the home of the project in `root` for this run; `home` is None where another run has it, or none can be.

    A process without a brain is a guest: it leaves the home to the one that has it.
    """

    def __init__(self, root: Path, *, guest: bool = False) -> None:
        self.root, self.taken = root, False
        self.home: Home | None = None
        home = Home(home_of(root))
        try:
            if guest:
                pass
            elif home.hold():
                self.home = home
            else:
                self.taken = True
        except UsageError as error:
            _log.warning("the exhibition can't be resumed nor reached from other terminals: %s", error)
        self.records = Records(self.home)
        self._door: Door | None = None
        self._bus = ""

    def begin(self, project: Project, files: Mapping[str, bytes]) -> None:
        """This project has no errors: its files are the last good ones."""
        if keeper := self.records.keeper:
            kept = keeper.kept()
            keeper.store(files)
            keeper.approve(project.hash)
            keeper.prune(project.hash, kept.bundle if kept else "")

    def open(self, bus: Bus, url: str, project: Project) -> None:
        """Let others find this run: by its broker, or through a door to the embedded bus."""
        self._bus = url
        if self.home and url.startswith("memory:"):
            try:
                self._door = Door(bus, self.home.folder)
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
            "command": command_key(project),
            "path": address.path if address else "",
            "port": address.port if address else 0,
            "key": address.key if address else "",
        }
        self.home.write(DOOR, json.dumps(data).encode())

    def close(self, *, forget: bool) -> None:
        """Give it back; `forget` where the run has ended as it should, and there is nothing to go on with."""
        if self.home is None:
            return
        home, self.home = self.home, None
        if self._door:
            self._door.close()
        home.remove(DOOR)
        if forget and self.records.keeper:
            self.records.keeper.forget()
        home.release()

    def last_good(self) -> Project | None:
        """The bundle that ran last and was good, None where none was kept."""
        keeper = self.records.keeper
        files = keeper.files(keeper.good()) if keeper else None
        return check_files(self.root, files)[0] if files else None

    def resumption(self, project: Project) -> Resumption | str:
        """How the run before is gone on with under this project; else why not, empty where there is nothing to say."""
        kept = self.records.keeper.kept() if self.records.keeper else None
        if kept is None:
            return ""
        away = time.time() - kept.time
        if not 0.0 <= away <= LATELY:
            return f"The last run ended without notice, but {_ago(away)}: this one begins anew."
        try:
            found = self._resumption(project, kept, away)
        except LumenError as error:
            return f"The last run ended without notice and can't be gone on with: {error}"
        if isinstance(found, Refusal):
            return f"The last run ended without notice, and these files can't go on from there: {found.reason}"
        return found

    def _resumption(self, project: Project, kept: Kept, away: float) -> Resumption | Refusal:
        assert self.records.keeper
        old: Project | None = project
        if kept.bundle != project.hash:
            files = self.records.keeper.files(kept.bundle)
            old = check_files(self.root, files)[0] if files else None
        if old is None or kept.behavior not in old.behaviors:
            return Refusal("its files were not kept")
        if kept.behavior != old.behavior:
            old = replace(old, behavior=kept.behavior)
        return resume(old, project, thaw(old.machine, kept.frozen), away, kept.tracking)


def _ago(seconds: float) -> str:
    """`12 s ago`, `5 min ago`, `3 h ago`."""
    if seconds < 0:
        return "in the future, by this machine's clock"
    for unit, name in ((3600.0, "h"), (60.0, "min")):
        if seconds >= 2 * unit:
            return f"{seconds / unit:.0f} {name} ago"
    return f"{seconds:.0f} s ago"
