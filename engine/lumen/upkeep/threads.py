"""Threads that nobody may miss: a fault costs what met it, a thread that ends by one is begun again, or told of."""

import logging
import threading
import time
from collections import deque
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from weakref import WeakSet

from lumen.upkeep.backoff import pause_after
from lumen.upkeep.drops import DropLog

MAX_FAULTS = 5
"""How often a thread may fail within `FAULT_PERIOD` until it is given up."""
FAULT_PERIOD = 60.0
"""[s]."""
FIRST_PAUSE = 0.05
"""How long after its first fault a thread begins again [s]; each further one twice as long."""
WATCH_PERIOD = 1.0
"""How often somebody looks whether the threads are there [s]."""
MAX_KINDS = 100
"""Kinds of faults that are logged with where they were raised."""

_log = logging.getLogger(__name__)
_watched: "WeakSet[WatchedThread]" = WeakSet()
_changing = threading.Lock()


class WatchedThread:
    """Does its `work` until that returns, and begins it anew after a fault.

    After `MAX_FAULTS` within a minute it is given up: `lost` says why. Where it is `vital` the robot rests then, for
    nobody could reach it any more. `work` has to find its way from wherever a fault left it.
    """

    def __init__(self, name: str, work: Callable[[], None], *, vital: bool = False) -> None:
        self.name, self.vital, self.lost = name, vital, ""
        self._work = work
        self._ending = threading.Event()
        self._faults: deque[float] = deque(maxlen=MAX_FAULTS)
        self._thread: threading.Thread | None = None

    @property
    def current(self) -> bool:
        """Whether the caller runs on it."""
        return threading.current_thread() is self._thread

    @property
    def started(self) -> bool:
        return self._thread is not None

    def start(self) -> None:
        with _changing:
            _watched.add(self)
        self._begin()

    def is_alive(self) -> bool:
        return self._thread is not None and self._thread.is_alive()

    def join(self, timeout: float | None = None) -> bool:
        """Wait until it has ended, at most `timeout` [s]; whether it has. It is not begun again."""
        self._ending.set()
        if self._thread is not None and not self.current:
            self._thread.join(timeout)
        return not self.is_alive()

    def revive(self) -> None:
        """Begin it again where it has died without ending its work; from a thread that watches over it."""
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
            except BaseException as error:  # whatever it is: nobody but its owner ends it
                if self._ending.is_set():
                    return
                _log.exception("the thread `%s` failed", self.name)
                if not self._again(repr(error)):
                    return

    def _again(self, why: str) -> bool:
        """Whether it may begin once more, after a pause."""
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
    """Who looks after all watched threads of this process: `tick` returns those that were given up since the last."""

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock, self._next = clock, 0.0
        self._told: WeakSet[WatchedThread] = WeakSet(thread for thread in _all() if thread.lost)

    def tick(self) -> list[WatchedThread]:
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
    """Lets a fault of ours cost no more than the message that met it.

    It is logged, with where it was raised for the first of its kind, and counted in `drops` under the message's key.
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
