"""Installs a proved bundle's files in the project's folder, and completes the installation after a crash."""

from collections.abc import Iterable, Iterator, Mapping
from contextlib import suppress
from pathlib import Path

from lumen.features.fleet.bundle import HASH, BadBundleError, packed, unpacked
from lumen.features.fleet.memory import AgentMemory, keep, memory_file, remember
from lumen.project.files import belongs, fingerprint, read_files
from lumen.project.home import Home, home_of
from lumen.project.project_folders import FLEET_FILE
from lumen.run.reload.restoring import replace_files, unwritten
from lumen.upkeep.own_folders import private_folder, write_private
from lumen.upkeep.regular_files import read_regular

MAX_FILE = 40_000_000


class BundleFolder:
    """A folder of bundles, created with the first bundle. Disk errors raise no exceptions."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def keep(self, files: Mapping[str, bytes]) -> str:
        """Write a bundle atomically, unless the folder has it undamaged; return the error, else an empty string."""
        hash = fingerprint(files)
        if self.files(hash) is not None:
            return ""
        try:
            private_folder(self.folder)
            write_private(self._path(hash), packed(files), durable=True)
        except OSError as error:
            return (error.strerror or str(error)).lower()
        return ""

    def files(self, hash: str) -> dict[str, bytes] | None:
        """Return the files of the bundle with that hash; None if it is missing or damaged."""
        if not HASH.fullmatch(hash):
            return None
        try:
            return unpacked(read_regular(self._path(hash), MAX_FILE, follow=False), hash)
        except (OSError, BadBundleError):
            return None

    def hashes(self) -> list[str]:
        """Return the hashes of the stored bundles, newest last; empty if the folder can't be read."""
        with suppress(OSError):
            found = sorted(self.folder.glob("*.zip"), key=lambda path: path.stat().st_mtime)
            return [path.stem for path in found if HASH.fullmatch(path.stem)]
        return []

    def prune(self, wanted: Iterable[str]) -> None:
        """Delete all bundles except those with these hashes."""
        for hash in {*self.hashes()} - {*wanted}:
            with suppress(OSError):
                self._path(hash).unlink()

    def _path(self, hash: str) -> Path:
        return self.folder / f"{hash}.zip"


FOLDER = "fleet"


def bundle_folder(root: Path) -> BundleFolder:
    """Return the folder in which a project's robots store bundles."""
    return BundleFolder(home_of(root) / FOLDER)


def install(root: Path, files: Mapping[str, bytes]) -> str:
    """Replace the project's files with these, and delete all others, or change none; return the error, if any.

    fleet.yaml stays. A link is replaced by a file.
    """
    there, wanted = _own(read_files(root)), _own(files)
    changed = {path for path in {*there, *wanted} if there.get(path) != wanted.get(path)}
    try:
        replace_files(root, {path: wanted.get(path) for path in sorted(changed)}, there)
    except OSError as error:
        return unwritten(error)
    return ""


def all_have(root: Path, hash: str, robots: Iterable[str]) -> bool:
    """Return whether each of these robots, which share the folder, last saved that it runs the files with `hash`."""
    known = {robot: memory for _, robot, memory in _memories(root)}
    return all(robot in known and known[robot].counted == hash for robot in robots)


def finish(root: Path) -> None:
    """Complete the installations that the end of a process interrupted, or that the disk refused.

    Skip an installation while another robot that shares the folder neither runs nor installs the same files.
    """
    found = list(_memories(root))
    for home, robot, memory in found:
        hash = memory.writing
        if not hash or any(other.writing != hash and other.counted != hash for _, _, other in found):
            continue
        files = bundle_folder(root).files(hash)
        if files is None or not install(root, files):
            written(home, robot, memory)


def written(home: Home, robot: str, memory: AgentMemory) -> None:
    """Save that the agent's files are installed."""
    memory.writing = ""
    keep(home, robot, memory)


def _memories(root: Path) -> Iterator[tuple[Home, str, AgentMemory]]:
    """Yield the home, robot name and memory of each agent of a project."""
    for file in sorted(home_of(root).rglob(memory_file("*"))):
        home, robot = Home(file.parent), file.name.removeprefix("fleet-").removesuffix(".json")
        yield home, robot, remember(home, robot)


def _own(files: Mapping[str, bytes]) -> dict[str, bytes]:
    """Return the files that a bundle can change: all project files except fleet.yaml."""
    return {path: content for path, content in files.items() if path != FLEET_FILE and belongs(path)}
