"""The watcher of a project's files: it notices saved files, and has them checked on another thread."""

import logging
import queue
import sys
import threading
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import closing, contextmanager
from pathlib import Path
from typing import Generic, NamedTuple, TypeVar

from lumen.project.files import Unreadable, fingerprint, read_files
from lumen.project.kept_contents import KeptContents
from lumen.project.project_folders import ALL_FOLDERS, MOTIONS
from lumen.upkeep.threads import WatchedThread

QUIET_PERIOD = 0.3
"""The time without a change after which files are checked [s]."""
SHORT_QUIET_FRACTION = 0.2
"""The share of the quiet period that suffices for a single complete and good file."""
MAX_READ_PERIOD = 1.0
"""The longest time between two readings of the files [s]."""
HINT_DEBOUNCE = 10
"""The time for which the operating system's notifications are collected [ms]."""
EARLY = 5.0
"""The time after a watcher's start at which the checker is prepared [s]; earlier, the exhibition is busy."""
SWITCH_INTERVAL = 0.001
"""The longest time that a thread may block the others [s]: a stop passes through four of them."""

_log = logging.getLogger(__name__)
WatchedFiles = Mapping[str, bytes]
T = TypeVar("T")


class SavedFiles(NamedTuple):
    """Files that have settled after a change."""

    files: WatchedFiles
    """The contents of all files of the project, by path."""
    changed: tuple[str, ...]
    """The paths of the files that differ from the files that were checked before."""
    seen: float
    """When the first change was noticed [s, monotonic]."""
    quiet: float
    """When the last change was a quiet period ago [s, monotonic]."""
    asked: object = None
    """The argument of `request` or `give`; None for files that were saved."""


class GivenFiles(NamedTuple):
    """Files that are not from the project's folder."""

    files: WatchedFiles
    asked: object
    """The value that is returned with the result for these files."""


class FileWatcher(Generic[T]):
    """A watcher that checks the project's files when their content has changed and settled, or on request.

    Notifications of the operating system only speed this up: the content decides, and is read at least once a second.
    Each result of `judge` goes to `results`.

    - `files` are the present files, `hash` is that of the running bundle if it differs, and files are read as for
      `robot`.
    - `leisure` is called with a result and a function that returns whether something more urgent waits.
    - `done` is called after a result, and `noticed` after a change, before it settles.
    - `early` is called once, EARLY after the start, with the running files.
    - Without `hints` only requests are served.
    - With `good`, a single changed file whose last line is unchanged is checked at once: if `good` is true for the
      result, a part of the quiet period is enough (docs/decisions/080).
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
        early: Callable[[WatchedFiles], None] = lambda files: None,
        good: Callable[[T], bool] | None = None,
        done: Callable[[], None] = lambda: None,
        robot: str = "",
    ) -> None:
        self._robot = robot
        self._root, self._files, self._hash, self._good = root, files, hash or fingerprint(files), good
        self._judge, self._leisure, self._noticed, self._quiet, self._watching = judge, leisure, noticed, quiet, hints
        self._early, self._done = early, done
        self._kept = KeptContents()
        self._stop, self._hint = threading.Event(), threading.Event()
        self._asked: queue.SimpleQueue[object] = queue.SimpleQueue()
        self.results: queue.SimpleQueue[T] = queue.SimpleQueue()
        self._threads = [WatchedThread("lumen-loading", self._load)]
        if hints:
            self._threads.append(WatchedThread("lumen-watching", self._watch))

    def start(self) -> None:
        """Start the threads."""
        for thread in self._threads:
            thread.start()

    def request(self, what: object) -> None:
        """Check the present files, changed or not; `what` is returned with the result."""
        self._asked.put(what)
        self._hint.set()

    def give(self, files: WatchedFiles, what: object) -> None:
        """Check files that are not from the folder; `what` is returned with the result."""
        self._asked.put(GivenFiles(files, what))
        self._hint.set()

    def write(self, change: Callable[[], WatchedFiles]) -> None:
        """Let `change` write to the folder on the thread that reads it, so that nothing half-written is read.

        `change` returns the files that are there afterwards; they run already, and are not checked.
        """
        self._asked.put(change)
        self._hint.set()

    def close(self) -> None:
        """End the threads, and wait until they have ended."""
        self._stop.set()
        self._hint.set()
        for thread in self._threads:
            thread.join()

    def _load(self) -> None:
        begun, ready = time.monotonic(), not self._watching
        while not self._stop.is_set():
            self._hint.wait(MAX_READ_PERIOD if self._watching else None)
            self._hint.clear()
            if not ready and not self._stop.is_set() and time.monotonic() - begun > EARLY:
                ready = True
                with _as_others_need():
                    self._early(self._files)
            while not self._asked.empty():
                self._serve(self._asked.get())
            if self._watching:
                self._look()

    def _serve(self, asked: object) -> None:
        if isinstance(asked, GivenFiles):
            now = time.monotonic()
            judged = self._judged(SavedFiles(asked.files, (), now, now, asked.asked))
            if judged is not None:
                self._tell(judged)
        elif callable(asked):
            self._files = asked()
            self._hash = fingerprint(self._files)
        else:
            self._look(asked)

    def _look(self, asked: object = None) -> None:
        saved = SavedFiles(self._read(), (), time.monotonic(), 0.0, asked)
        judged: T | None = None
        if new := fingerprint(saved.files) != self._hash:
            self._noticed()
            judged, saved = self._settled(saved)
            new = fingerprint(saved.files) != self._hash
        if self._stop.is_set() or not (new or asked):
            return
        if judged is None:
            judged = self._judged(saved)
        if not asked or self._watching:
            self._files, self._hash = saved.files, fingerprint(saved.files)
        if judged is not None:
            self._tell(judged)
            with _as_others_need():
                self._leisure(judged, self._urgent)

    def _read(self) -> WatchedFiles:
        return read_files(self._root, self._robot, self._kept)

    def _tell(self, judged: T) -> None:
        self.results.put(judged)
        self._done()

    def _judged(self, saved: SavedFiles) -> T | None:
        """Return the result for these files; None after an internal error."""
        changed = tuple(sorted(_differing(saved.files, self._files)))
        with _as_others_need():
            return self._judge(saved._replace(changed=changed, quiet=time.monotonic()))
        return None

    def _urgent(self) -> bool:
        """Return whether a request waits, or the files have changed: most hints come without a change."""
        if not self._hint.is_set():
            return False
        self._hint.clear()
        if self._stop.is_set() or not self._asked.empty() or (self._watching and self._changed()):
            self._hint.set()
        return self._hint.is_set()

    def _changed(self) -> bool:
        return fingerprint(self._read()) != self._hash

    def _settled(self, saved: SavedFiles) -> tuple[T | None, SavedFiles]:
        """Return the files once they have not changed for long enough, and the result if they were checked already."""
        since, judged = time.monotonic(), self._judged_at_once(saved)
        while not self._stop.is_set():
            self._hint.clear()
            again = self._read()
            if again != saved.files:
                saved = saved._replace(files=again)
                since, judged = time.monotonic(), self._judged_at_once(saved)
                continue
            needed = self._needed(saved.files)
            if judged is not None and self._good and self._good(judged):
                needed *= SHORT_QUIET_FRACTION
            if (left := since + needed - time.monotonic()) <= 0:
                break
            self._stop.wait(min(left, self._quiet / 6))
        return judged, saved

    def _judged_at_once(self, saved: SavedFiles) -> T | None:
        """Return the result if the files look complete, rather than half-written; else None."""
        return self._judged(saved) if self._good and self._watching and _whole(saved.files, self._files) else None

    def _needed(self, files: WatchedFiles) -> float:
        half = any(not files.get(path) or isinstance(files[path], Unreadable) for path in self._files)
        return 2 * self._quiet if half else self._quiet

    def _watch(self) -> None:
        from watchfiles import watch

        while not self._stop.is_set():
            folders = watched_folders(self._root)
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
                        if watched_folders(self._root) != folders:
                            break
            except OSError as error:
                _log.warning("the system no longer reports saved files, so Lumen reads them once a second: %r", error)
                return


def _whole(files: WatchedFiles, before: WatchedFiles) -> bool:
    """Return whether exactly one file differs, and its last line is the same: a half-written file ends elsewhere."""
    match list(_differing(files, before)):
        case [path] if path in files and path in before:
            return _end(files[path]) == _end(before[path]) != b""
    return False


def _end(text: bytes) -> bytes:
    """Return the last line of a file with its line break; empty if the file has no line or can't be read."""
    lines = [] if isinstance(text, Unreadable) else text.splitlines(keepends=True)
    return lines[-1] if lines else b""


def _differing(files: WatchedFiles, others: WatchedFiles) -> Iterator[str]:
    return (path for path in {*files, *others} if files.get(path) != others.get(path))


@contextmanager
def _as_others_need() -> Iterator[None]:
    """Let the exhibition's threads run sooner than Python would, and log any error instead of raising it."""
    usual = sys.getswitchinterval()
    sys.setswitchinterval(SWITCH_INTERVAL)
    try:
        yield
    except Exception:
        _log.exception("the saved files could not be checked")
    finally:
        sys.setswitchinterval(usual)


def watched_folders(root: Path) -> dict[Path, tuple[int, int]]:
    """Return the watched folders that exist, with device and inode, because a folder may be replaced under its name.

    If the project's folder is a link, the folder that contains the link is watched too.
    """
    robots = [*sorted((root / MOTIONS).glob("*/")), *sorted((root / MOTIONS).glob("*/life/"))]
    wanted = [root, *(root / name for name in sorted(ALL_FOLDERS)), *robots]
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
