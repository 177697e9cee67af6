"""Lumen's own folders: private ones with names, pictures or keys, the user's state, and a cache that may be deleted."""

import os
import stat
from contextlib import suppress
from pathlib import Path

IGNORE_FILE = ".gitignore"
_IGNORING = b"# Written by Lumen: here are names, pictures and keys.\n*\n"

NO_LINK = getattr(os, "O_NOFOLLOW", 0)
"""The flag of `os.open` that refuses links: a link in a foreign project may lead to any of the user's files."""


def private_folder(folder: Path) -> None:
    """Make a folder if it is missing, with a .gitignore that excludes all of it from version control.

    An existing .gitignore is kept. Raises OSError if the folder can't be made.
    """
    folder.mkdir(parents=True, exist_ok=True)
    with suppress(OSError):
        handle = os.open(folder / IGNORE_FILE, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o644)
        with open(handle, "wb", buffering=0) as file:
            file.write(_IGNORING)


def write_private(path: Path, content: bytes, *, durable: bool = False) -> None:
    """Write a file that only its owner can read, completely or not at all. Raises OSError on failure.

    A crash of the process loses neither the old nor the new file. After a power cut the old one may come back, unless
    `durable` forces the content to the disk.
    """
    draft = path.with_name(f"{path.name}.new")
    with open(os.open(draft, os.O_WRONLY | os.O_CREAT | os.O_TRUNC | NO_LINK, 0o600), "wb") as file:
        file.write(content)
        if durable:
            file.flush()
            os.fsync(file.fileno())
    os.replace(draft, path)


def state_folder() -> Path:
    """Return Lumen's state folder among the user's own files (the XDG Base Directory Specification)."""
    given = os.environ.get("XDG_STATE_HOME") or os.environ.get("LOCALAPPDATA")
    try:
        return Path(given) / "lumen" if given else Path.home() / ".local" / "state" / "lumen"
    except RuntimeError:  # a user without a home
        import tempfile  # late: it imports shutil and random, which lint does not need

        return Path(tempfile.gettempdir()) / f"lumen-{os.getuid() if hasattr(os, 'getuid') else ''}"


MAX_FILES = 64
"""The default number of files of a kind that are kept: those written or read last."""


class CacheFolder:
    """The cached files of one kind, by name; a file that can't be read or written counts as missing.

    The folder is among the user's own files and not in the project, because its content is trusted, while a project of
    other people may contain any file. A folder that other users can write to is not used.
    """

    def __init__(self, kind: str, most: int = MAX_FILES) -> None:
        self._folder, self._most = _own() / kind, most

    def read(self, name: str) -> bytes | None:
        """Return the content under a name; None if no file has it."""
        try:
            content = (self._folder / name).read_bytes() if self._private() else None
        except OSError:
            return None
        with suppress(OSError):
            os.utime(self._folder / name)
        return content

    def write(self, name: str, content: bytes) -> None:
        """Save content completely or not at all, then delete the least recently used files beyond the limit."""
        draft = self._folder / f".{os.urandom(16).hex()}"
        try:
            self._folder.mkdir(mode=0o700, parents=True, exist_ok=True)
            if not self._private():
                return
            draft.write_bytes(content)
            os.replace(draft, self._folder / name)
            for old in sorted(self._folder.iterdir(), key=_used, reverse=True)[self._most :]:
                old.unlink(missing_ok=True)
        except OSError:
            with suppress(OSError):
                draft.unlink(missing_ok=True)

    def _private(self) -> bool:
        """Return True if only this user can write to the folder; on Windows users' folders are always separate."""
        if not hasattr(os, "getuid"):
            return True
        status = self._folder.stat()
        return status.st_uid == os.getuid() and not stat.S_IMODE(status.st_mode) & 0o022


def _used(file: Path) -> float:
    try:
        return file.stat().st_mtime
    except OSError:  # another program was faster
        return 0.0


def _own() -> Path:
    """Return the folder for this user's cached files (the XDG Base Directory Specification)."""
    given = os.environ.get("XDG_CACHE_HOME") or os.environ.get("LOCALAPPDATA")
    try:
        return Path(given) / "lumen" if given else Path.home() / ".cache" / "lumen"
    except RuntimeError:  # a user without a home
        return Path(os.devnull) / "lumen"
