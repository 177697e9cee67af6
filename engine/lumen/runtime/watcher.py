"""Sees that a project's files were saved, and has them judged where nobody waits for it."""

import logging
import queue
import sys
import threading
import time
from collections.abc import Callable, Mapping
from contextlib import closing
from pathlib import Path
from typing import Generic, NamedTuple, TypeVar

from lumen.loading.files import PROJECT_FOLDERS, Unreadable, fingerprint, read_files
from lumen.upkeep.threads import WatchedThread

QUIET_PERIOD = 0.3
MAX_READ_PERIOD = 1.0
HINT_DEBOUNCE = 20
"""How long the operating system's notices are gathered [ms]."""
SWITCH_INTERVAL = 0.001
"""How long one thread may keep the others of an exhibition from their work [s]: a stop passes four on its way."""

NESTED_FOLDERS = ("behaviors/stories", "behaviors/words", "schemas/messages")

_log = logging.getLogger(__name__)
WatchedFiles = Mapping[str, bytes]
T = TypeVar("T")


class SavedFiles(NamedTuple):
    """Files as they were once quiet, `changed` those that differ from what was judged before, by path.

    `seen` [s, monotonic] is when the first change was noticed, `quiet` when the last had been for the quiet period.
    `asked` is what was handed to `ask`, None where nobody asked.
    """

    files: WatchedFiles
    changed: tuple[str, ...]
    seen: float
    quiet: float
    asked: object = None


class FileWatcher(Generic[T]):
    """Judges the project's files anew whenever their content has changed and stayed quiet, or when somebody asks.

    The operating system's notice of a saved file is a hint that hurries it; what decides is the content, read at least
    once a second. `files` are those before, `hash` that of the bundle that runs where it is another. `results` yields
    what `judge` makes of each new content, good or bad. `leisure` is then given what was judged, and a function that
    says whether there is something more urgent. `noticed` is called when a change shows, before it has settled.
    Without `hints` only who asks is served.
    """

    def __init__(
        self,
        root: Path,
        files: WatchedFiles,
        judge: Callable[[SavedFiles], T],
        *,
        hash: str = "",
        quiet: float = QUIET_PERIOD,
        hints: bool = True,
        leisure: Callable[[T, Callable[[], bool]], None] = lambda judged, urgent: None,
        noticed: Callable[[], None] = lambda: None,
    ) -> None:
        self._root, self._files, self._hash = root, files, hash or fingerprint(files)
        self._judge, self._leisure, self._noticed, self._quiet, self._watching = judge, leisure, noticed, quiet, hints
        self._stop, self._hint = threading.Event(), threading.Event()
        self._asked: queue.SimpleQueue[object] = queue.SimpleQueue()
        self.results: queue.SimpleQueue[T] = queue.SimpleQueue()
        self._threads = [WatchedThread("lumen-loading", self._load)]
        if hints:
            self._threads.append(WatchedThread("lumen-watching", self._watch))

    def start(self) -> None:
        for thread in self._threads:
            thread.start()

    def ask(self, what: object) -> None:
        """Judge the files as they are now, changed or not; `what` comes back with it."""
        self._asked.put(what)
        self._hint.set()

    def close(self) -> None:
        """End the threads; returns when they have ended."""
        self._stop.set()
        self._hint.set()
        for thread in self._threads:
            thread.join()

    def _load(self) -> None:
        while not self._stop.is_set():
            self._hint.wait(MAX_READ_PERIOD if self._watching else None)
            self._hint.clear()
            while not self._asked.empty():
                self._look(self._asked.get())
            if self._watching:
                self._look()

    def _look(self, asked: object = None) -> None:
        seen = time.monotonic()
        files = read_files(self._root)
        new = fingerprint(files) != self._hash
        if new:
            self._noticed()
            files = self._settled(files)
            new = fingerprint(files) != self._hash
        if self._stop.is_set() or not (new or asked):
            return
        changed = tuple(path for path in sorted({*files, *self._files}) if files.get(path) != self._files.get(path))
        if not asked or self._watching:
            self._files, self._hash = files, fingerprint(files)
        usual = sys.getswitchinterval()
        sys.setswitchinterval(SWITCH_INTERVAL)
        try:
            judged = self._judge(SavedFiles(files, changed, seen, time.monotonic(), asked))
            self.results.put(judged)
            self._leisure(judged, self._urgent)
        except Exception:  # a fault of ours must not end the watching
            _log.exception("the saved files could not be judged")
        finally:
            sys.setswitchinterval(usual)

    def _urgent(self) -> bool:
        return self._hint.is_set()

    def _settled(self, files: dict[str, bytes]) -> dict[str, bytes]:
        """The files once they have not changed for the quiet period.

        Twice as long where one is gone, empty or can't be read: somebody may be about to write it.
        """
        since = time.monotonic()
        while time.monotonic() - since < self._needed(files) and not self._stop.wait(self._quiet / 6):
            self._hint.clear()
            again = read_files(self._root)
            if again != files:
                files, since = again, time.monotonic()
        return files

    def _needed(self, files: WatchedFiles) -> float:
        half = any(not files.get(path) or isinstance(files[path], Unreadable) for path in self._files)
        return 2 * self._quiet if half else self._quiet

    def _watch(self) -> None:
        from watchfiles import watch

        while not self._stop.is_set():
            folders = _folders(self._root)
            changes = watch(
                *folders,
                watch_filter=None,
                recursive=False,
                stop_event=self._stop,
                step=HINT_DEBOUNCE,
                debounce=HINT_DEBOUNCE,
                rust_timeout=int(MAX_READ_PERIOD * 1000),
                yield_on_timeout=True,
                raise_interrupt=False,
            )
            try:
                with closing(changes):
                    for _ in changes:
                        self._hint.set()
                        if _folders(self._root) != folders:
                            break
            except OSError as error:
                _log.warning("files are no longer watched, only read once a second: %r", error)
                return


def _folders(root: Path) -> dict[Path, tuple[int, int]]:
    """The folders to be watched that are there now, and which they are: one of the same name may take their place.

    Where the project's folder is a link, the one that the link is in counts too.
    """
    wanted = [root, *(root / name for name in (*PROJECT_FOLDERS, *NESTED_FOLDERS))]
    if root.is_symlink():
        wanted.append(root.absolute().parent)
    found = {}
    for folder in wanted:
        try:
            status = folder.stat()
        except OSError:
            continue
        if folder.is_dir():
            found[folder] = (status.st_dev, status.st_ino)
    return found
