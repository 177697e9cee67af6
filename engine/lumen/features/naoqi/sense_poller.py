"""The five senses, each acquired by a thread of its own while commands execute."""

import logging
import threading
from collections.abc import Callable

from lumen.errors import RobotError
from lumen.features.naoqi.session import CONNECTION_LOST, NaoqiSession
from lumen.ports import Reading
from lumen.upkeep.threads import WatchedThread

SENSE_RETRY_DELAY = 1.0
"""How long a sense that failed is left alone [s]."""

_log = logging.getLogger(__name__)


class SensePoller:
    """Asks for one sense over and over; `newest` is what came of it, None where the robot can't give it now.

    Trouble costs that sense alone: it is logged once for each reason, and tried again every second.
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
        """A reading that is acquired from now on; the newest, where none comes within `timeout` [s]."""
        with self._changed:
            self._wanted = wanted = self._rounds + 1 + self._busy  # the round that goes on began before
            self._hurry.set()
            self._changed.wait_for(lambda: self._rounds >= wanted, timeout)
        return self.newest

    def close(self) -> None:
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
        """Acquire once; how long to wait until the next time [s]."""
        if not self._session.ready:
            self.newest = None
            return self._period
        try:
            self.newest = self._acquire()
        except RobotError as error:
            self.newest = None
            if self._session.ready and str(error) != CONNECTION_LOST and not self._ending.is_set():
                self._tell(str(error))
            return SENSE_RETRY_DELAY
        except Exception as error:  # what the robot said is not what we understand: the next reading may be
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
