"""What this user's programs have worked out once, kept on the disk: nothing is lost where it is deleted."""

import os
import stat
from contextlib import suppress
from pathlib import Path

MAX_FILES = 64
"""How many files of a kind are kept where nothing else is said: those that were made or read last."""


class CacheFolder:
    """Files of one kind, by name; one that can't be read or written is as good as none.

    It lies among the user's own files and not in a project: what is in it is believed, and whoever sends a project may
    send any file with it. A folder that others may write is not used.
    """

    def __init__(self, kind: str, most: int = MAX_FILES) -> None:
        self._folder, self._most = _own() / kind, most

    def read(self, name: str) -> bytes | None:
        """What is kept under that name, None where nothing is."""
        try:
            content = (self._folder / name).read_bytes() if self._private() else None
        except OSError:
            return None
        with suppress(OSError):
            os.utime(self._folder / name)
        return content

    def write(self, name: str, content: bytes) -> None:
        """Keep it, whole or not at all; the oldest go where there are too many."""
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
        """Whether nobody else may write it; Windows keeps the folders of its users apart by itself."""
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
    """Where this user's programs keep what they can make again (the XDG Base Directory Specification)."""
    given = os.environ.get("XDG_CACHE_HOME") or os.environ.get("LOCALAPPDATA")
    try:
        return Path(given) / "lumen" if given else Path.home() / ".cache" / "lumen"
    except RuntimeError:  # a user without a home
        return Path(os.devnull) / "lumen"
