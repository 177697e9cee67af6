"""The files of the other processes, which follow the brain's: a bundle that the brain activates is loaded here too."""

import queue
import sys
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

from lumen.language.events import Event
from lumen.language.projects import Project
from lumen.motion.bounds import analyse
from lumen.ports import Bus, Message
from lumen.project.chosen_robot import as_robot
from lumen.project.files import fingerprint, read_files
from lumen.project.home import Home, home_of
from lumen.run.parts.part import Part
from lumen.run.reload.requests import status_key
from lumen.run.snapshot_store import SnapshotStore
from lumen.run.watcher import SWITCH_INTERVAL
from lumen.upkeep.threads import WatchedThread

MOVED = ("applied", "rolled back")
"""The verdicts after which the brain runs another bundle."""


class BundleFollower(Part):
    """The part that loads the bundles which the brain of the project's robot activates, on its own thread.

    `use` is called with each loaded bundle, `tell` with a line about it, or about files here that differ from the
    brain's, as on another machine.
    """

    patient = True

    def __init__(
        self, root: Path, project: Project, bus: Bus, use: Callable[[Project], None], tell: Callable[[str], None]
    ) -> None:
        self._root, self._robot, self._adopt, self._tell = root, project.one_of_several, use, tell
        self._wanted: queue.SimpleQueue[str | None] = queue.SimpleQueue()
        self._loaded: queue.SimpleQueue[Project | str] = queue.SimpleQueue()
        self._undo = bus.subscribe(status_key(project.robot), self._hear)
        self._thread = WatchedThread("lumen-bundles", self._run)
        self._thread.start()

    def tick(self, now: float, changes: Sequence[Event]) -> None:
        while not self._loaded.empty():
            found = self._loaded.get()
            if isinstance(found, str):
                self._tell(found)
            else:
                self._tell("the brain's new files are active here, too")
                self._adopt(found)

    def close(self) -> None:
        self._undo()
        self._wanted.put(None)
        self._thread.join()

    def _hear(self, message: Message) -> None:
        body = message.body
        if isinstance(body, dict) and body.get("verdict") in MOVED and isinstance(body.get("after"), str):
            self._wanted.put(body["after"])

    def _run(self) -> None:
        from lumen.lint import check_files  # this imports all rules, which a single process does not need here

        missed = ""
        while (wanted := self._latest()) is not None:
            usual = sys.getswitchinterval()
            sys.setswitchinterval(SWITCH_INTERVAL)
            try:
                files = self._files(wanted)  # only files that the brain has accepted are read
                project = check_files(self._root, files)[0] if files else None
                if project is not None:
                    analyse(project.motions.values(), project.body)
            finally:
                sys.setswitchinterval(usual)
            if project is not None:
                missed = ""
                self._loaded.put(project)
            elif not missed:
                missed = "the files on this machine differ from the brain's new files, which only the brain uses"
                self._loaded.put(missed)

    def _files(self, wanted: str) -> Mapping[str, bytes] | None:
        """Return the files whose hash is `wanted`; None if they are not on this machine.

        They come from the project's folder, or from the bundles that a brain on this machine keeps.
        """
        files = read_files(self._root, self._robot)
        if fingerprint(files) == wanted:
            return files
        kept = SnapshotStore(Home(home_of(self._root, self._robot))).files(wanted)
        return as_robot(kept, self._robot) if kept else None

    def _latest(self) -> str | None:
        """Wait for a wanted hash; return the newest one, None at the end."""
        wanted = self._wanted.get()
        while wanted is not None and not self._wanted.empty():
            wanted = self._wanted.get()
        return wanted
