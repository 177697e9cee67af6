"""What an exhibition needs to go on after a crash: where its behaviour stood, and the very files it ran on."""

import time
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

from lumen.errors import LumenError
from lumen.journal.journal_folder import named_bundles
from lumen.language.projects import Project
from lumen.project.files import MAX_PROJECT_BYTES, fingerprint
from lumen.project.home import Home
from lumen.run.bundles import DamagedBundleError, packed, unpacked
from lumen.statechart import Snapshot, serialize

SNAPSHOT_FILE, ALIVE_FILE = "snapshot.json", "alive.json"
LAST_GOOD_FILE = "good.json"
SNAPSHOT_VERSION = 1
SNAPSHOT_SPACING = 0.02
"""How long after a snapshot the next is written at the earliest [s]: a simulation may take a hundred steps in that."""


class StoredSnapshot(NamedTuple):
    """A snapshot as it was written: of which bundle and behaviour, at which time (Unix), frozen.

    `tracking` are the controllers that were on, `rests` is whether the robot was at rest. The run lived until `ended`,
    and was `told` to end by the system, or nobody knows why it did.
    """

    bundle: str
    behavior: str
    time: float
    frozen: Mapping[str, Any]
    tracking: tuple[str, ...] = ()
    rests: bool = False
    ended: float = 0.0
    told: bool = False


class SnapshotStore:
    """Writes snapshots (`count` of them) and bundles into a home; `trouble` says why it could not, once.

    Where only the time of a snapshot differs from the one before, nothing is written: its timers have deadlines.
    """

    def __init__(self, home: Home) -> None:
        self._home = home
        self._last: Snapshot | None = None
        self._written = 0.0
        self.trouble = ""
        self.count = 0

    def due(self, snapshot: Snapshot) -> bool:
        """Whether it is news, and the last was not written just now."""
        last = self._last
        if last is snapshot or (last is not None and _same(last, snapshot)):
            return False
        return time.perf_counter() - self._written >= SNAPSHOT_SPACING

    def keep(self, project: Project, snapshot: Snapshot, tracking: Sequence[str], *, rests: bool = False) -> None:
        """Write where the project's behaviour stands, if that is due."""
        if not self.due(snapshot):
            return
        self._written = time.perf_counter()
        try:
            frozen = serialize(project.machine, snapshot)
        except LumenError as error:
            self._wrote(str(error))
            return
        data = {
            "version": SNAPSHOT_VERSION,
            "bundle": project.hash,
            "behavior": project.behavior,
            "time": time.time(),
            "tracking": list(tracking),
            "rests": rests,
            "snapshot": frozen,
        }
        self._wrote(self._home.write_json(SNAPSHOT_FILE, data))
        self._last = snapshot
        self.count += 1

    def beat(self) -> None:
        """The run lives: where its behaviour stands is as true as when it was written."""
        self._wrote(self._home.write_json(ALIVE_FILE, {"time": time.time()}))

    def leave(self) -> None:
        """The run was told to end: the next one goes on where its behaviour stands."""
        self._wrote(self._home.write_json(ALIVE_FILE, {"time": time.time(), "told": True}))

    def kept(self) -> StoredSnapshot | None:
        """The snapshot of a run that did not end by itself, None where there is none that can be read."""
        try:
            data = self._home.read_json(SNAPSHOT_FILE)
            if data["version"] != SNAPSHOT_VERSION:
                return None
            tracking = tuple(map(str, data["tracking"]))
            written = float(data["time"])
            alive, told = self._alive()
            return StoredSnapshot(
                str(data["bundle"]),
                str(data["behavior"]),
                written,
                dict(data["snapshot"]),
                tracking,
                data.get("rests") is True,
                max(written, alive),
                told and alive >= written,
            )
        except (ValueError, TypeError, KeyError, OverflowError):
            return None

    def of_another_version(self) -> tuple[str, bool]:
        """The version of a snapshot that another Lumen has left, or nothing; and whether the robot rests."""
        data = self._home.read_json(SNAPSHOT_FILE)
        said = data.get("version", SNAPSHOT_VERSION) if isinstance(data, Mapping) else SNAPSHOT_VERSION
        return ("", False) if said == SNAPSHOT_VERSION else (str(said)[:20], data.get("rests") is True)

    def forget(self) -> None:
        """The run has ended as it should: there is nothing to go on with."""
        self._home.remove(SNAPSHOT_FILE)
        self._home.remove(ALIVE_FILE)
        self._last = None

    def store(self, files: Mapping[str, bytes]) -> str:
        """Keep the files of a bundle; return its hash. A file of that name that is damaged is replaced."""
        hash = fingerprint(files)
        if self.files(hash) is None:
            self._wrote(self._home.write(_name(hash), packed(files)))
        return hash

    def files(self, hash: str) -> dict[str, bytes] | None:
        """The files of a bundle that was kept, None where they are not there as they were."""
        try:
            found = unpacked(self._home.read(_name(hash)) or b"", 2 * MAX_PROJECT_BYTES)
        except DamagedBundleError:
            return None
        return found if fingerprint(found) == hash else None

    def approve(self, hash: str) -> None:
        """This bundle has proved itself: it is the last good one."""
        self._wrote(self._home.write_json(LAST_GOOD_FILE, {"version": SNAPSHOT_VERSION, "bundle": hash}))

    def good(self) -> str:
        """The hash of the last good bundle, empty where there is none."""
        try:
            data = self._home.read_json(LAST_GOOD_FILE)
            return str(data["bundle"]) if data["version"] == SNAPSHOT_VERSION else ""
        except (TypeError, KeyError):
            return ""

    def prune(self, *hashes: str) -> None:
        """Delete the files of all bundles but these, and those that the journal needs."""
        names = {_name(hash) for hash in {*hashes, *named_bundles(self._home.folder)}}
        for path in self._home.folder.glob("bundle-*.zip"):
            if path.name not in names:
                self._home.remove(path.name)

    def _alive(self) -> tuple[float, bool]:
        """When the run was last known to live (Unix), 0 where that is not known; whether it was told to end then."""
        try:
            said = self._home.read_json(ALIVE_FILE)
            return float(said["time"]), said.get("told") is True
        except (ValueError, TypeError, KeyError, AttributeError):
            return 0.0, False

    def _wrote(self, trouble: str) -> None:
        self.trouble = self.trouble or trouble


def _same(one: Snapshot, other: Snapshot) -> bool:
    return one._replace(at=0.0) == other._replace(at=0.0)


def _name(hash: str) -> str:
    return f"bundle-{hash[:16]}.zip"
