"""The folder `.lumen/` of a project, in which a running exhibition keeps its address and its state for a restart."""

import hashlib
import json
import os
import sys
from contextlib import suppress
from pathlib import Path
from typing import Any

from lumen.errors import UsageError
from lumen.project.packaged import PACKAGE
from lumen.upkeep.own_folders import NO_LINK, private_folder, state_folder, write_private
from lumen.upkeep.regular_files import read_regular

STATE_FOLDER = ".lumen"
ADDRESS_FILE = "door.json"
ROBOTS_FOLDER = "robots"
"""The folder with one home for each robot of `robots:`."""
MAX_RECORD_BYTES = 64_000_000
"""The maximum size of one file of a home [bytes]; the saved state of a behaviour has a few thousand."""


class Home:
    """The folder of one running exhibition, locked with `hold`; the system unlocks it however the process ends.

    While the exhibition runs, no fault of the disk raises an error: `write` returns the reason instead.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self._lock: int | None = None

    def hold(self) -> bool:
        """Create the folder and lock it; return True, or False if another process holds the lock.

        Raises UsageError if the folder can't be made.
        """
        try:
            private_folder(self.folder)
            lock = os.open(self.folder / "lock", os.O_RDWR | os.O_CREAT | NO_LINK, 0o600)
        except OSError as error:
            raise UsageError(f"{self.folder} can't be written: {error.strerror}") from None
        if not _locked(lock):
            os.close(lock)
            return False
        self._lock = lock
        return True

    def held(self) -> bool:
        """Return True if any process holds the lock now."""
        try:
            lock = os.open(self.folder / "lock", os.O_RDWR | NO_LINK)
        except OSError:
            return False
        free = _locked(lock)
        os.close(lock)
        return not free

    def release(self) -> None:
        if self._lock is not None:
            os.close(self._lock)
            self._lock = None

    def write(self, name: str, data: bytes) -> str:
        """Write a file as `write_private` does; return the reason if that failed, else an empty text."""
        try:
            write_private(self.folder / name, data)
        except OSError as error:
            return (error.strerror or str(error)).lower()
        return ""

    def write_json(self, name: str, data: Any) -> str:
        """Write data as a file of JSON; return the reason if that failed, else an empty text."""
        return self.write(name, json.dumps(data).encode())

    def read(self, name: str) -> bytes | None:
        """Return the content of a file; None if it can't be read."""
        try:
            return read_regular(self.folder / name, MAX_RECORD_BYTES, follow=False)
        except OSError:
            return None

    def read_json(self, name: str) -> Any:
        """Return the data in a file of JSON; None if the file can't be read or is not JSON."""
        try:
            return json.loads(self.read(name) or b"null")
        except (ValueError, RecursionError):
            return None

    def remove(self, name: str) -> None:
        with suppress(OSError):
            (self.folder / name).unlink()


def home_of(root: Path, robot: str = "") -> Path:
    """Return the folder for an exhibition of the project in `root`, for this `robot` if the project has `robots:`.

    It is `.lumen/` in the project. It is in the user's state folder instead, under a name made from the project's path,
    if the project can't be written, comes with an installed Lumen or is a link, or if its `.lumen/` is or contains a
    link. A project that another person sent may hold a `.lumen/` with links, through which files elsewhere would be
    written.
    """
    within = Path(ROBOTS_FOLDER, robot) if robot else Path()
    return _whole_home(root) / within


def homes_of(root: Path) -> list[Home]:
    """Return the homes that exhibitions of the project may have: its own, and one for each of its robots."""
    whole = home_of(root)
    return [Home(whole), *(Home(one) for one in sorted((whole / ROBOTS_FOLDER).glob("*/")))]


def _whole_home(root: Path) -> Path:
    inside = root / STATE_FOLDER
    own = not root.is_symlink() and not _linked(inside) and PACKAGE.resolve() not in root.resolve().parents
    if own and os.access(inside if inside.is_dir() else root, os.W_OK):
        return inside
    digest = hashlib.sha256(os.fsencode(root.absolute())).hexdigest()[:12]
    return state_folder() / f"{root.name}-{digest}"


def _linked(folder: Path) -> bool:
    """Return True if a folder is a link or contains one, so that writing into it might write somewhere else."""
    below = ([here, *files, *folders] for here, folders, files in os.walk(folder))
    return folder.is_symlink() or any(
        os.path.islink(os.path.join(here, name)) for here, *names in below for name in names
    )


def homes() -> list[Home]:
    """Return all homes that are not inside their projects."""
    folder = state_folder()
    return [Home(one) for one in sorted(folder.iterdir())] if folder.is_dir() else []


def _locked(file: int) -> bool:
    """Try to lock the file exclusively, without waiting; return True on success. The lock ends with the process."""
    try:
        if sys.platform == "win32":
            import msvcrt

            msvcrt.locking(file, msvcrt.LK_NBLCK, 1)
        else:
            import fcntl

            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        return False
    return True
