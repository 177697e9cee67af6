"""Whether there is room on the disk."""

import shutil
import threading
from pathlib import Path

from lumen.upkeep.threads import WatchedThread

LEAST_ROOM = 100_000_000
"""How much room a disk has to have [bytes]: the database, the journal and a bundle need that in a bad month."""
LOOK_INTERVAL = 60.0
"""How often it is looked [s]; on a thread, for a disk of the network may take its time."""


class DiskWatch:
    """`trouble` says how little room there is where `folder` is, empty where there is enough."""

    def __init__(self, folder: Path) -> None:
        self.trouble = ""
        self._folder = folder
        self._ending = threading.Event()
        self._thread = WatchedThread("lumen-disk", self._run)
        self._thread.start()

    def close(self) -> None:
        """Nobody waits for a disk that does not answer."""
        self._ending.set()
        self._thread.join(0.1)

    def _run(self) -> None:
        while True:
            self.trouble = room(self._folder)
            if self._ending.wait(LOOK_INTERVAL):
                return


def room(folder: Path) -> str:
    """What is wrong with the room on the disk of that folder, or of the nearest above it that is there."""
    while not folder.exists() and folder != folder.parent:
        folder = folder.parent
    try:
        free = shutil.disk_usage(folder).free
    except OSError as error:
        return f"the free space of the disk can't be read: {error.strerror}"
    return f"the disk is nearly full: {free / 1e6:.0f} MB are left" if free < LEAST_ROOM else ""
