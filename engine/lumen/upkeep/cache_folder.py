"""A cache on the disk for the results of this user's programs; it may be deleted at any time."""

import os
import stat
from contextlib import suppress
from pathlib import Path

MAX_FILES = 64
"""Default number of files of a kind that are kept, those made or read last."""


class CacheFolder:
    """The cached files of one kind, by name; a file that can't be read or written counts as missing.

    It is among the user's own files and not in a project, because its content is trusted, and a project from elsewhere
    may contain any file. A folder that others may write to is not used.
    """

    def __init__(self, kind: str, most: int = MAX_FILES) -> None:
        self._folder, self._most = _own() / kind, most

    def read(self, name: str) -> bytes | None:
        """Return the content under a name, or None."""
        try:
            content = (self._folder / name).read_bytes() if self._private() else None
        except OSError:
            return None
        with suppress(OSError):
            os.utime(self._folder / name)
        return content

    def write(self, name: str, content: bytes) -> None:
        """Save a content completely or not at all; delete the oldest files above the limit."""
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
        """Return whether only this user may write to the folder; on Windows users' folders are always separate."""
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
