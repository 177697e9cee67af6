"""Sees that a project's files were saved, and loads them where nobody waits for it."""

import logging
import queue
import threading
import time
from collections.abc import Sequence
from pathlib import Path

from lumen.language.diagnostics import Diagnostic
from lumen.language.projects import Project
from lumen.loading.files import FOLDERS, fingerprint, read_files
from lumen.rules import check_files

QUIET = 0.3
LOOK = 1.0

_log = logging.getLogger(__name__)
Bundle = tuple[Project | None, Sequence[Diagnostic]]


class Watcher:
    """A thread that loads and lints the project anew whenever the content of its files has changed and stayed quiet.

    The operating system's notice of a saved file is a hint that hurries it; what decides is the content, read at least
    once a second. `hash` is that of the bundle that runs. `results` yields what `check_files` made of each new content,
    good or bad.
    """

    def __init__(self, root: Path, hash: str) -> None:
        self._root, self._hash = root, hash
        self._stop = threading.Event()
        self.results: queue.SimpleQueue[Bundle] = queue.SimpleQueue()
        self._thread = threading.Thread(target=self._run, name="lumen-watcher", daemon=True)

    def start(self) -> None:
        self._thread.start()

    def close(self) -> None:
        """End the thread; returns when it has ended."""
        self._stop.set()
        self._thread.join()

    def _run(self) -> None:
        from watchfiles import watch

        folders = [folder for name in FOLDERS if (folder := self._root / name).is_dir()]
        changes = watch(
            *folders,
            stop_event=self._stop,
            step=50,
            debounce=200,
            rust_timeout=int(LOOK * 1000),
            yield_on_timeout=True,
            raise_interrupt=False,
        )
        try:
            for _ in changes:
                self._look()
        except OSError as error:
            _log.warning("files are no longer watched, only read once a second: %r", error)
            while not self._stop.wait(LOOK):
                self._look()

    def _look(self) -> None:
        files = read_files(self._root)
        if fingerprint(files) == self._hash:
            return
        files = self._settled(files)
        self._hash = fingerprint(files)
        try:
            self.results.put(check_files(self._root, files))
        except Exception:  # a fault of ours must not end the watching
            _log.exception("the saved files could not be checked")

    def _settled(self, files: dict[str, bytes]) -> dict[str, bytes]:
        """The files once they have not changed for the quiet period."""
        since = time.monotonic()
        while time.monotonic() - since < QUIET and not self._stop.wait(QUIET / 6):
            again = read_files(self._root)
            if again != files:
                files, since = again, time.monotonic()
        return files
