"""The thread of one sense: it encodes and publishes readings, and blocks only callers that choose to wait."""

import logging
import re
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from lumen.errors import LumenError, RobotError
from lumen.ports import OtherReading
from lumen.upkeep.threads import WatchedThread

MAX_LOGGED_REASONS = 20

_DIGITS = re.compile(r"\d+")
_log = logging.getLogger(__name__)


@dataclass
class PublishCounts:
    """Counts of a sense's readings."""

    published: int = 0
    dropped: int = 0
    """Readings that a newer one replaced."""
    refused: int = 0
    """Readings that could not be encoded or that the bus refused."""
    off: str = ""
    """Why the sense is off; empty while it is on."""


@dataclass(eq=False)
class PendingReading:
    """A reading that waits to be published."""

    reading: OtherReading
    after: "PendingReading | None" = None
    """The reading that must be published before this one; None if this one need not wait."""
    began: float = 0.0
    """When the publishing of the reading began [s, monotonic]."""
    begun: threading.Event = field(default_factory=threading.Event)
    """Set when its publishing begins."""
    done: threading.Event = field(default_factory=threading.Event)
    """Set when its publishing has ended."""

    def begin(self) -> None:
        self.began = time.monotonic()
        self.begun.set()

    def end(self) -> None:
        self.after = None
        self.done.set()
        self.begun.set()


class SensePublisher:
    """One thread for one sense, with room for one reading: the newest wins, the others are counted as dropped.

    `encode` makes the body and `publish` sends it, both on this thread. If the bus refuses a body, or a package can't
    make it (LumenError), only that body is lost, and each reason is logged once. If the robot can't give the sense
    (RobotError: a camera without OpenGL), the sense is off, with a line in the log, until `arm`. A `direct` publisher
    has no thread: `hand` returns once the reading has been published.
    """

    PATIENCE = 1.0

    def __init__(
        self,
        name: str,
        encode: Callable[[Any], dict[str, Any]],
        publish: Callable[[Any], None],
        *,
        direct: bool = False,
    ) -> None:
        self.name = name
        self.count = PublishCounts()
        self._encode, self._publish = encode, publish
        self._next: PendingReading | None = None
        self._changed = threading.Condition()
        self._ending = False
        self._said: set[str] = set()
        self._thread = None if direct else self._started()

    def hand(self, handed: PendingReading) -> None:
        """Publish this reading next; it replaces one that still waits. While the sense is off, drop it."""
        if self._thread is None and not self.count.off:
            self._perform(handed)
            return
        with self._changed:
            if self.count.off:
                handed.end()
                return
            if self._next:
                self.count.dropped += 1
                self._next.end()
            self._next = handed
            self._changed.notify()

    def arm(self) -> None:
        """Restart a sense that is off, and log refusals again, because their cause may be gone."""
        with self._changed:
            self._said.clear()
            off, self.count.off = self.count.off, ""
            if self._thread and off and not self._ending:
                self._thread = self._started()

    def close(self, timeout: float) -> bool:
        """Publish the waiting reading and end the thread; return True if both were done within `timeout` [s]."""
        with self._changed:
            self._ending = True
            self._changed.notify()
        return self._thread is None or self._thread.join(max(0.0, timeout))

    def _started(self) -> WatchedThread:
        thread = WatchedThread(f"lumen-{self.name}", self._run)
        thread.start()
        return thread

    def _run(self) -> None:
        while (handed := self._take()) and self._perform(handed):
            pass

    def _take(self) -> PendingReading | None:
        with self._changed:
            self._changed.wait_for(lambda: self._next or self._ending)
            handed, self._next = self._next, None
            return handed

    def _perform(self, handed: PendingReading) -> bool:
        """Encode and publish one reading; return False if the sense is off now."""
        try:
            self._send(handed)
        except RobotError as error:
            self._off(str(error))
            return False
        except LumenError as error:
            self._refused(str(error))
        except Exception as error:  # a defect of Lumen costs this reading only
            self._refused(repr(error), error)
        finally:
            handed.end()
        return True

    def _send(self, handed: PendingReading) -> None:
        body = self._encode(handed.reading)
        if handed.after:
            handed.after.done.wait(self.PATIENCE)
        handed.begin()
        self._publish(body)
        self.count.published += 1

    def _refused(self, reason: str, fault: Exception | None = None) -> None:
        """Count a refusal; log each reason once, whatever its numbers, and a `fault` of Lumen with its traceback."""
        self.count.refused += 1
        with self._changed:
            kind = _DIGITS.sub("#", reason)
            new = kind not in self._said and len(self._said) < MAX_LOGGED_REASONS and not self._ending
            if new:
                self._said.add(kind)
        if new:
            _log.warning("a reading of the sense `%s` was refused: %s", self.name, reason, exc_info=fault)

    def _off(self, reason: str) -> None:
        with self._changed:
            self.count.off = reason
            if self._next:
                self._next.end()
                self._next = None
        if not self._ending:
            _log.warning("the sense `%s` is switched off: %s", self.name, reason)
