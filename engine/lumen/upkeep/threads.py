"""Threads that are essential for an exhibition: they are restarted after a fault, and reported once given up."""

import logging
import threading
import time
from collections import deque
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from weakref import WeakSet

from lumen.upkeep.drops import DropLog
from lumen.upkeep.ratelimit import pause_after

MAX_FAULTS = 5
"""The number of faults within FAULT_PERIOD after which a thread is given up."""
FAULT_PERIOD = 60.0
"""The period in which faults are counted [s]."""
FIRST_PAUSE = 0.05
"""The pause before a thread restarts after its first fault [s]; it doubles with each further fault."""
WATCH_PERIOD = 1.0
"""The time between two checks of the threads [s]."""
MAX_KINDS = 100
"""The maximum number of kinds of faults that are logged with their tracebacks."""

_log = logging.getLogger(__name__)
_watched: "WeakSet[WatchedThread]" = WeakSet()
_changing = threading.Lock()


class WatchedThread:
    """A thread that calls `work` until it returns, and calls it again after a fault.

    After MAX_FAULTS within FAULT_PERIOD it is given up. `work` must be able to continue after a fault.
    """

    def __init__(self, name: str, work: Callable[[], None], *, vital: bool = False) -> None:
        self.name, self.vital, self.lost = name, vital, ""
        """`vital` is true if the robot must rest once the thread is given up, because no person could stop it then.

        `lost` is the reason why the thread was given up; empty if it was not.
        """
        self._work = work
        self._ending = threading.Event()
        self._faults: deque[float] = deque(maxlen=MAX_FAULTS)
        self._thread: threading.Thread | None = None

    @property
    def current(self) -> bool:
        """True if the caller runs on this thread."""
        return threading.current_thread() is self._thread

    @property
    def started(self) -> bool:
        """True if the thread was started at some time."""
        return self._thread is not None

    def start(self) -> None:
        """Start the thread; if the system refuses, `lost` is the reason."""
        with _changing:
            _watched.add(self)
        self._begin()

    def is_alive(self) -> bool:
        """Return True if the thread is running."""
        return self._thread is not None and self._thread.is_alive()

    def join(self, timeout: float | None = None) -> bool:
        """Wait for the thread for at most `timeout` [s], None for no limit; return True if it has ended.

        It is not restarted from now on. The thread itself does not wait.
        """
        self._ending.set()
        if self._thread is not None and not self.current:
            self._thread.join(timeout)
        return not self.is_alive()

    def revive(self) -> None:
        """Restart the thread if it died without finishing its work; called by a `ThreadWatch`."""
        if self.started and not self.is_alive() and not self._ending.is_set() and not self.lost:
            _log.error("the thread `%s` died and is being restarted", self.name)
            if self._again("it died"):
                self._begin()

    def _begin(self) -> None:
        thread = threading.Thread(target=self._run, name=self.name, daemon=True)
        try:
            thread.start()
        except RuntimeError as error:
            self.lost = f"the system cannot start the thread `{self.name}`: {error}"
            return
        self._thread = thread

    def _run(self) -> None:
        while not self._ending.is_set():
            try:
                self._work()
                self._ending.set()
            except BaseException as error:  # any error, even SystemExit: only its owner ends the thread
                if self._ending.is_set():
                    return
                _log.exception("the thread `%s` failed", self.name)
                if not self._again(repr(error)):
                    return

    def _again(self, why: str) -> bool:
        """Count a fault and wait for the pause; return True if the thread may run again."""
        now = time.monotonic()
        self._faults.append(now)
        recent = sum(now - at < FAULT_PERIOD for at in self._faults)
        if recent >= MAX_FAULTS:
            self.lost = (
                f"the thread `{self.name}` failed {recent} times within {FAULT_PERIOD:g} s; the last error: {why}"
            )
            _log.error("%s", self.lost)
            return False
        return not self._ending.wait(pause_after(recent, FIRST_PAUSE))


def _all() -> list[WatchedThread]:
    with _changing:
        return list(_watched)


class ThreadWatch:
    """Restarts dead threads of this process, and reports those that were given up."""

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock, self._next = clock, 0.0
        self._told: WeakSet[WatchedThread] = WeakSet(thread for thread in _all() if thread.lost)

    def tick(self) -> list[WatchedThread]:
        """Every WATCH_PERIOD, restart dead threads and return those that were given up since the last time.

        Calls in between return an empty list.
        """
        if self._clock() < self._next:
            return []
        self._next = self._clock() + WATCH_PERIOD
        watched = _all()
        for thread in watched:
            thread.revive()
        lost = [thread for thread in watched if thread.lost and thread not in self._told]
        self._told.update(lost)
        return lost


class MessageGuard:
    """A context manager in which an error loses only the message that caused it; call it with the message's key.

    The error is counted in `drops` under that key, and the first of its kind is logged with a traceback.
    """

    def __init__(self, log: logging.Logger, what: str) -> None:
        self.drops = DropLog(log)
        self._log, self._what = log, what
        self._kinds: set[tuple[str, str]] = set()

    @contextmanager
    def __call__(self, key: str) -> Iterator[None]:
        try:
            yield
        except Exception as error:
            kind = (key, type(error).__name__)
            if kind not in self._kinds and len(self._kinds) < MAX_KINDS:
                self._kinds.add(kind)
                self._log.exception("%s could not process a message on `%s`", self._what, key)
            self.drops.add(key, f"{self._what} could not process it: {error!r}")
