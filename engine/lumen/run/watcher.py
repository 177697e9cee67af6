"""Sees that a project's files were saved, and has them judged where nobody waits for it."""

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
SHORT_QUIET_FRACTION = 0.2
"""The part of the quiet period for which a single file that is whole and good has to stay as it is."""
MAX_READ_PERIOD = 1.0
HINT_DEBOUNCE = 10
"""How long the operating system's notices are gathered [ms]."""
EARLY = 5.0
"""How long after its beginning a watcher has what judges made ready [s]: until then an exhibition has enough to do."""
SWITCH_INTERVAL = 0.001
"""How long one thread may keep the others of an exhibition from their work [s]: a stop passes four on its way."""

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


class GivenFiles(NamedTuple):
    """Files to be judged that do not lie in the project's folder, and what comes back with the verdict."""

    files: WatchedFiles
    asked: object


class FileWatcher(Generic[T]):
    """Judges the project's files anew whenever their content has changed and stayed quiet, or when somebody asks.

    The operating system's notice of a saved file is a hint that hurries it; what decides is the content, read at least
    once a second. `files` are those before, `hash` that of the bundle that runs where it is another. `results` yields
    what `judge` makes of each new content, good or bad. `leisure` is then given what was judged, and a function that
    says whether there is something more urgent. `done` is called when there is a result, `noticed` when a change shows,
    before it has settled, `early` once, EARLY after the beginning, with the files that run. Without `hints` only who
    asks is served. The files are read as that `robot` of several does.

    With `good` one file that ends as it did before is judged at once: where that is said of what came of it, a part of
    the quiet period is enough (docs/decisions/080).
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
        for thread in self._threads:
            thread.start()

    def ask(self, what: object) -> None:
        """Judge the files as they are now, changed or not; `what` comes back with it."""
        self._asked.put(what)
        self._hint.set()

    def give(self, files: WatchedFiles, what: object) -> None:
        """Judge these files, which do not lie in the folder; `what` comes back with it."""
        self._asked.put(GivenFiles(files, what))
        self._hint.set()

    def write(self, change: Callable[[], WatchedFiles]) -> None:
        """Let the folder be changed, on the thread that reads it: nothing half-written is read.

        The files that `change` gives back run already: they are not judged.
        """
        self._asked.put(change)
        self._hint.set()

    def close(self) -> None:
        """End the threads; returns when they have ended."""
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
        """What comes of these files; None where we fail on them."""
        changed = tuple(sorted(_differing(saved.files, self._files)))
        with _as_others_need():
            return self._judge(saved._replace(changed=changed, quiet=time.monotonic()))
        return None

    def _urgent(self) -> bool:
        return self._hint.is_set()

    def _settled(self, saved: SavedFiles) -> tuple[T | None, SavedFiles]:
        """The files once they have not changed for long enough, and what came of them where that was asked already."""
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
        """What comes of them, where they look like what somebody wanted to save, and not like a half of it."""
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
    """Whether one file differs, and ends as it did before: what was not written to its end ends anywhere else."""
    match list(_differing(files, before)):
        case [path] if path in files and path in before:
            return _end(files[path]) == _end(before[path]) != b""
    return False


def _end(text: bytes) -> bytes:
    """The last line of a file, empty where there is none or it can't be read; it has to be ended as well."""
    lines = [] if isinstance(text, Unreadable) else text.splitlines(keepends=True)
    return lines[-1] if lines else b""


def _differing(files: WatchedFiles, others: WatchedFiles) -> Iterator[str]:
    return (path for path in {*files, *others} if files.get(path) != others.get(path))


@contextmanager
def _as_others_need() -> Iterator[None]:
    """The exhibition's threads have their turn sooner than Python would let them, and a fault of ours ends nothing."""
    usual = sys.getswitchinterval()
    sys.setswitchinterval(SWITCH_INTERVAL)
    try:
        yield
    except Exception:
        _log.exception("the saved files could not be checked")
    finally:
        sys.setswitchinterval(usual)


def watched_folders(root: Path) -> dict[Path, tuple[int, int]]:
    """The folders to be watched that are there now, and which they are: one of the same name may take their place.

    Where the project's folder is a link, the one that the link is in counts too.
    """
    robots = sorted((root / MOTIONS).glob("*/"))
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
