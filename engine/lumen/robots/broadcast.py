"""A sense's own thread: it encodes and publishes what it is handed, and never keeps anybody waiting."""

import logging
import threading
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from lumen.errors import BusError, RobotError
from lumen.ports import Reading

_log = logging.getLogger(__name__)


@dataclass
class Count:
    """What became of a sense's readings; `off` says why there are no more."""

    published: int = 0
    dropped: int = 0
    off: str = ""


@dataclass(eq=False)
class Handed:
    """A reading on its way; it is published after the one handed over before it, if there is one to wait for."""

    reading: Reading
    after: "Handed | None" = None
    done: threading.Event = field(default_factory=threading.Event)

    def end(self) -> None:
        self.after = None
        self.done.set()


class Broadcast:
    """One thread for one sense, with room for one reading: the newest wins, the others are counted as dropped.

    `encode` makes the body and `publish` sends it, both on this thread. The sense switches itself off, with a line in
    the log, where the robot can't give it (RobotError) or the bus is closed.
    """

    PATIENCE = 1.0

    def __init__(self, name: str, encode: Callable[[Any], dict[str, Any]], publish: Callable[[Any], None]) -> None:
        self.name = name
        self.count = Count()
        self._encode, self._publish = encode, publish
        self._next: Handed | None = None
        self._changed = threading.Condition()
        self._ending = False
        self._thread = threading.Thread(target=self._run, name=f"lumen-{name}", daemon=True)
        self._thread.start()

    def hand(self, handed: Handed) -> None:
        """Take this reading next; the one that still waits gives way."""
        with self._changed:
            if self._next:
                self.count.dropped += 1
                self._next.end()
            self._next = handed
            if self.count.off:
                handed.end()
            self._changed.notify()

    def close(self, timeout: float) -> bool:
        """Publish what waits and end; whether that was done within `timeout` [s]."""
        with self._changed:
            self._ending = True
            self._changed.notify()
        self._thread.join(max(0.0, timeout))
        return not self._thread.is_alive()

    def _run(self) -> None:
        while handed := self._take():
            try:
                self._perform(handed)
            except (RobotError, BusError) as error:
                self._off(str(error))
            except Exception as error:
                self._off(repr(error))
                raise
            finally:
                handed.end()
            if self.count.off:
                return

    def _take(self) -> Handed | None:
        with self._changed:
            self._changed.wait_for(lambda: self._next or self._ending)
            handed, self._next = self._next, None
            return handed

    def _perform(self, handed: Handed) -> None:
        body = self._encode(handed.reading)
        if handed.after:
            handed.after.done.wait(self.PATIENCE)
        self._publish(body)
        self.count.published += 1

    def _off(self, reason: str) -> None:
        with self._changed:
            self.count.off = reason
            if self._next:
                self._next.end()
        if not self._ending:
            _log.warning("the sense `%s` is switched off: %s", self.name, reason)
