"""Restores the connection when it breaks, and reports its loss and its return."""

import logging
import threading
import time
from collections import deque
from collections.abc import Callable
from typing import NamedTuple

from lumen.errors import RobotError
from lumen.features.naoqi.session import NaoqiSession
from lumen.upkeep.ratelimit import Backoff
from lumen.upkeep.threads import WatchedThread

FIRST_RETRY_DELAY, MAX_RETRY_DELAY = 0.5, 10.0
"""The wait before the first attempt to reconnect, and the maximum wait [s]; the wait doubles each time."""

_log = logging.getLogger(__name__)


class ConnectionChange(NamedTuple):
    """A change of the connection."""

    name: str
    """`robot.lost` or `robot.back`."""
    seconds: float
    """The time for which the robot was away [s]; 0 for `robot.lost`."""
    reason: str
    """The reason for the loss; empty for `robot.back`."""


class Reconnector:
    """Opens a session and keeps it open; `take_over(again)` prepares the robot after each connection.

    `again` is False only for the first connection. `first` is the wait before the first attempt to reconnect [s].
    """

    def __init__(
        self, session: NaoqiSession, take_over: Callable[[bool], None], first: float = FIRST_RETRY_DELAY
    ) -> None:
        self._session, self._take_over, self._first = session, take_over, first
        self._changes: deque[ConnectionChange] = deque(maxlen=100)
        self._broken, self._ending = threading.Event(), threading.Event()
        self._lost_at = 0.0
        self._thread = WatchedThread("lumen-naoqi", self._keep)

    def open(self) -> None:
        """Connect for the first time, and start the thread that reconnects.

        Raises RobotError if the robot can't be connected or prepared.
        """
        try:
            self._session.open()
            self._take_over(False)
            self._session.ready = self._session.up
        except RobotError:
            self._session.close()
            raise
        self._thread.start()

    def lose(self, reason: str) -> None:
        """Record and log that the connection broke. Any thread may call this."""
        self._lost_at = time.monotonic()
        self._changes.append(ConnectionChange("robot.lost", 0.0, reason))
        if not self._ending.is_set():
            _log.warning("the connection to the robot is lost: %s; Lumen tries to reach it again", reason)
        self._broken.set()

    def changes(self) -> list[ConnectionChange]:
        """Return the connection's changes since the last call."""
        return [self._changes.popleft() for _ in range(len(self._changes))]

    def close(self) -> None:
        """End the attempts to reconnect and the thread."""
        self._ending.set()
        self._broken.set()
        self._thread.join(2.0)

    def _keep(self) -> None:
        while not self._ending.is_set():
            if self._session.up:
                self._broken.wait()
            self._broken.clear()
            backoff = Backoff(self._first, MAX_RETRY_DELAY)
            while not self._session.up and not self._ending.wait(backoff.next()):
                self._try()

    def _try(self) -> None:
        lost_at = self._lost_at
        try:
            self._session.open()
            self._take_over(True)
            self._session.ready = self._session.up
        except RobotError as error:
            self._session.close()
            _log.info("the robot is still unreachable: %s", error)
            return
        except Exception:  # a fault in Lumen must not end the attempts
            self._session.close()
            _log.exception("the robot could not be reached")
            return
        away = time.monotonic() - lost_at
        self._changes.append(ConnectionChange("robot.back", away, ""))
        _log.warning("the robot is back, after %.0f s", away)
