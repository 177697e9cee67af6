"""An exhibition's recordings: the files in its home, and notes about those that are being written anywhere."""

import os
import uuid
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import NamedTuple

from lumen.errors import UsageError
from lumen.project.home import Home
from lumen.upkeep.own_folders import private_folder

RECORDINGS_FOLDER, RING_FOLDER = "recordings", "ring"
SUFFIX = ".mcap"
DAY, MEGABYTE = 86400.0, 1_000_000
_NOTE = ".begun"


class BegunRecording(NamedTuple):
    """A recording that has a note; `written` is True while a process is writing it."""

    path: Path
    written: bool


class RecordingsFolder:
    """The folder `recordings/` in an exhibition's home."""

    def __init__(self, home: Path) -> None:
        self.path = home / RECORDINGS_FOLDER
        self.ring = self.path / RING_FOLDER

    def make(self) -> None:
        """Create the folder and the ring's. Raises OSError if that fails."""
        private_folder(self.path.parent)
        private_folder(self.path)
        private_folder(self.ring)

    def files(self) -> list[Path]:
        """Return the recordings in the folder, the oldest first."""
        found = [(file.stat().st_mtime, file) for file in self.path.glob(f"*{SUFFIX}") if file.is_file()]
        return [file for _, file in sorted(found)]

    def parts(self) -> list[Path]:
        """Return the pieces of the ring, the oldest first."""
        return sorted(self.ring.glob(f"*{SUFFIX}"))

    def begin(self, path: Path) -> Home | None:
        """Return a new note that says, until it is released, that `path` is being written; None if it can't be made."""
        note = Home(self.path / f"{uuid.uuid4().hex[:12]}{_NOTE}")
        try:
            self.make()
            if not note.hold():
                return None
        except (OSError, UsageError):
            return None
        note.write("path", os.fsencode(path.absolute()))
        return note

    def begun(self) -> Iterator[BegunRecording]:
        """Yield all begun recordings that exist; delete notes whose recording is missing and not being written."""
        for folder in sorted(self.path.glob(f"*{_NOTE}")):
            note = Home(folder)
            said = note.read("path")
            path = Path(os.fsdecode(said)) if said else None
            written = note.held()
            if path and path.is_file() and not path.is_symlink():
                yield BegunRecording(path, written)
            elif not written:
                _remove(folder)

    def prune(self, now: float, keep: float, size: float) -> None:
        """Delete recordings older than `keep` days, and the oldest beyond `size` MB in total.

        The newest is never deleted for its size, and none that is being written is deleted.
        """
        left = 0
        begun = {each.path.absolute() for each in self.begun() if each.written}
        for number, file in enumerate(reversed(self.files())):
            with suppress(OSError):
                said = file.stat()
                left += said.st_size
                old = now - said.st_mtime > keep * DAY or (number and left > size * MEGABYTE)
                if old and file.absolute() not in begun:
                    file.unlink()


def _remove(folder: Path) -> None:
    for file in folder.iterdir():
        with suppress(OSError):
            file.unlink()
    with suppress(OSError):
        folder.rmdir()
