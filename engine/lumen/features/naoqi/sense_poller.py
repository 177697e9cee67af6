"""Reads each of the robot's senses on a separate thread while commands run."""

import logging
import threading
from collections.abc import Callable

from lumen.errors import RobotError, RobotLostError
from lumen.features.naoqi.session import NaoqiSession
from lumen.ports import Reading
from lumen.upkeep.threads import WatchedThread

SENSE_RETRY_DELAY = 1.0
"""The pause after a failed reading [s]."""

_log = logging.getLogger(__name__)


class SensePoller:
    """Reads one sense every `period` [s] with `acquire`; `newest` is the last reading, None after a failure.

    A failure affects only this sense: each new reason is logged, and reading is retried every second.
    """

    def __init__(self, name: str, session: NaoqiSession, acquire: Callable[[], Reading], period: float) -> None:
        self.name = name
        self.newest: Reading | None = None
        self._session, self._acquire, self._period = session, acquire, period
        self._told = ""
        self._rounds = self._wanted = 0
        self._busy = False
        self._changed = threading.Condition()
        self._ending = threading.Event()
        self._hurry = threading.Event()
        self._thread = WatchedThread(f"lumen-naoqi-{name}", self._run)
        self._thread.start()

    def fresh(self, timeout: float = 5.0) -> Reading | None:
        """Return a reading that begins after this call; None if it failed.

        After `timeout` [s], return the newest reading instead.
        """
        with self._changed:
            self._wanted = wanted = self._rounds + 1 + self._busy  # a round in progress began earlier
            self._hurry.set()
            self._changed.wait_for(lambda: self._rounds >= wanted, timeout)
        return self.newest

    def close(self) -> None:
        """End the thread."""
        self._ending.set()
        self._hurry.set()
        self._thread.join(1.0)

    def _run(self) -> None:
        while not self._ending.is_set():
            with self._changed:
                self._busy = True
            pause = self._round()
            with self._changed:
                self._busy, self._rounds = False, self._rounds + 1
                if self._rounds >= self._wanted and not self._ending.is_set():
                    self._hurry.clear()
                self._changed.notify_all()
            self._hurry.wait(pause)

    def _round(self) -> float:
        """Read once; return the wait until the next reading [s]."""
        if not self._session.ready:
            self.newest = None
            return self._period
        try:
            self.newest = self._acquire()
        except RobotError as error:
            self.newest = None
            if self._session.ready and not isinstance(error, RobotLostError) and not self._ending.is_set():
                self._tell(str(error))
            return SENSE_RETRY_DELAY
        except Exception as error:  # an unexpected form of answer; the next answer may be valid
            self.newest = None
            _log.debug("a reading of the sense `%s` failed", self.name, exc_info=error)
            self._tell(repr(error))
            return SENSE_RETRY_DELAY
        if self._told:
            self._told = ""
            _log.warning("the sense `%s` is back", self.name)
        return self._period

    def _tell(self, reason: str) -> None:
        if reason != self._told:
            self._told = reason
            _log.warning("the sense `%s` is not available: %s; everything else continues", self.name, reason)
