"""The data that an exhibition needs to resume after a crash: the behaviour's snapshot, and the exact files that ran."""

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
"""The least time between two snapshots [s]; a simulation may run a hundred steps in that time."""


class StoredSnapshot(NamedTuple):
    """A snapshot as it was written."""

    bundle: str
    """The hash of the bundle."""
    behavior: str
    """The name of the behaviour."""
    time: float
    """When the snapshot was written [s since 1970]."""
    frozen: Mapping[str, Any]
    """The serialised snapshot."""
    tracking: tuple[str, ...] = ()
    """The names of the controllers that were on."""
    rests: bool = False
    """Whether the robot was at rest."""
    ended: float = 0.0
    """When the run was last known to be alive [s since 1970]."""
    told: bool = False
    """Whether the operating system ordered the run to end."""


class SnapshotStore:
    """A store of snapshots and bundles in a home.

    A snapshot that differs from the last only in its time is not written, because timers have deadlines.
    """

    def __init__(self, home: Home) -> None:
        self._home = home
        self._last: Snapshot | None = None
        self._written = 0.0
        self.trouble = ""
        """The reason of the first failed write; empty if no write failed."""
        self.count = 0
        """The number of snapshots written."""

    def due(self, snapshot: Snapshot) -> bool:
        """Return whether a snapshot is new, and the last one was written at least SNAPSHOT_SPACING ago."""
        last = self._last
        if last is snapshot or (last is not None and _same(last, snapshot)):
            return False
        return time.perf_counter() - self._written >= SNAPSHOT_SPACING

    def keep(self, project: Project, snapshot: Snapshot, tracking: Sequence[str], *, rests: bool = False) -> None:
        """Write the behaviour's snapshot, if it is due."""
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
        """Record that the run is alive and its snapshot still valid."""
        self._wrote(self._home.write_json(ALIVE_FILE, {"time": time.time()}))

    def leave(self) -> None:
        """Record that the run was ordered to end, so that the next one resumes it."""
        self._wrote(self._home.write_json(ALIVE_FILE, {"time": time.time(), "told": True}))

    def kept(self) -> StoredSnapshot | None:
        """Return the snapshot that the last run left; None if it is missing, unreadable or of another version."""
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
        """Return the version and the robot's rest in a snapshot that another version of Lumen wrote.

        The version is an empty string, and the rest False, without such a snapshot.
        """
        data = self._home.read_json(SNAPSHOT_FILE)
        said = data.get("version", SNAPSHOT_VERSION) if isinstance(data, Mapping) else SNAPSHOT_VERSION
        return ("", False) if said == SNAPSHOT_VERSION else (str(said)[:20], data.get("rests") is True)

    def forget(self) -> None:
        """Delete the snapshot of a run that ended normally."""
        self._home.remove(SNAPSHOT_FILE)
        self._home.remove(ALIVE_FILE)
        self._last = None

    def store(self, files: Mapping[str, bytes]) -> str:
        """Store the files of a bundle, and replace a damaged copy of it; return its hash."""
        hash = fingerprint(files)
        if self.files(hash) is None:
            self._wrote(self._home.write(_name(hash), packed(files)))
        return hash

    def has(self, hash: str) -> bool:
        """Return whether a bundle is stored, damaged or not."""
        return (self._home.folder / _name(hash)).exists()

    def files(self, hash: str) -> dict[str, bytes] | None:
        """Return the files of a stored bundle; None if they are missing or damaged."""
        try:
            found = unpacked(self._home.read(_name(hash)) or b"", 2 * MAX_PROJECT_BYTES)
        except DamagedBundleError:
            return None
        return found if fingerprint(found) == hash else None

    def approve(self, hash: str) -> None:
        """Record that this bundle is the last good one."""
        self._wrote(self._home.write_json(LAST_GOOD_FILE, {"version": SNAPSHOT_VERSION, "bundle": hash}))

    def good(self) -> str:
        """Return the hash of the last good bundle, else an empty string."""
        try:
            data = self._home.read_json(LAST_GOOD_FILE)
            return str(data["bundle"]) if data["version"] == SNAPSHOT_VERSION else ""
        except (TypeError, KeyError):
            return ""

    def prune(self, *hashes: str) -> None:
        """Delete the files of all bundles except these and those that the journal needs."""
        names = {_name(hash) for hash in {*hashes, *named_bundles(self._home.folder)}}
        for path in self._home.folder.glob("bundle-*.zip"):
            if path.name not in names:
                self._home.remove(path.name)

    def _alive(self) -> tuple[float, bool]:
        """Return when the run was last alive [s since 1970], and whether it was then ordered to end.

        The time is 0 if unknown.
        """
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
