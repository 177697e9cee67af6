"""Count dropped items by key, and write lines about them: one for the first drop, then counts of further drops."""

import logging
import re
import threading
import time
from collections import deque
from collections.abc import Callable, Mapping
from contextlib import suppress
from math import inf
from typing import TypeVar

TELL_PERIOD = 10.0
"""The minimum time between two lines about a key [s]."""
MAX_KEYS = 1_000
"""The maximum number of keys that are counted separately; drops under further keys are counted as `OTHERS`."""
OTHERS = "other keys"

T = TypeVar("T")
_DIGITS = re.compile(r"\d+")


class Drops:
    """A counter of drops that reports them by `write`: the first under a key at once, then a count every ten seconds.

    All methods may be called on any thread. The owner calls `tell` from time to time, and at its end, so that the last
    drops are reported too. `what` names the dropped items in the lines.
    """

    def __init__(
        self, write: Callable[[str], None], what: str = "messages", clock: Callable[[], float] = time.monotonic
    ) -> None:
        self._write, self._what, self._clock = write, what, clock
        self._counts: dict[str, int] = {}
        self.untold: dict[str, tuple[int, str]] = {}
        """The number of drops that are not reported yet and their last reason, by key."""
        self._told: dict[str, float] = {}
        self._changing = threading.Lock()

    @property
    def counts(self) -> Mapping[str, int]:
        """The number of drops under each key."""
        with self._changing:
            return dict(self._counts)

    def add(self, key: str, why: str, count: int = 1) -> None:
        """Count drops under a key; `why` is the reason in the line about these drops."""
        with self._changing:
            key = key if key in self._counts or len(self._counts) < MAX_KEYS else OTHERS
            first = key not in self._told
            self._counts[key] = self._counts.get(key, 0) + count
            if first:
                self._told[key] = self._clock()
            else:
                self.untold[key] = (self.untold.get(key, (0, ""))[0] + count, why)
        if first:
            self._write(f"{self._what} on `{key}` are dropped: {why}")

    def push(self, waiting: deque[T], item: T, key_of: Callable[[T], str], why: str) -> None:
        """Append an item to a bounded queue; if it is full, drop the oldest item and count it under its key."""
        if len(waiting) == waiting.maxlen:
            with suppress(IndexError):  # another thread has just removed it
                self.add(key_of(waiting.popleft()), why)
        waiting.append(item)

    def tell(self, *, all: bool = False) -> None:
        """Report the drops under each key whose last line is at least ten seconds old; with `all`, under every key."""
        if not self.untold:
            return
        now = self._clock()
        with self._changing:
            due = [key for key in self.untold if all or now - self._told[key] >= TELL_PERIOD]
            told = [(key, *self.untold.pop(key), now - self._told[key]) for key in due]
            self._told.update(dict.fromkeys(due, now))
        for key, count, why, seconds in told:
            self._write(f"more {self._what} on `{key}` were dropped ({count} in {seconds:.0f} s): {why}")


class DropLog(Drops):
    """A counter of drops whose lines are warnings of a logger."""

    def __init__(
        self, log: logging.Logger, what: str = "messages", clock: Callable[[], float] = time.monotonic
    ) -> None:
        super().__init__(log.warning, what, clock)


class ReasonLog:
    """Logs reasons as warnings, each at most once in ten seconds; repetitions are counted in `drops`.

    Reasons that differ only in numbers are the same. New reasons beyond MAX_KEYS are only counted. `line` is the text,
    with the placeholders `%(key)s` and `%(reason)s`.
    """

    def __init__(
        self,
        log: logging.Logger,
        line: str,
        drops: DropLog | None = None,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self.drops = drops or DropLog(log, clock=clock)
        self._log, self._line, self._clock = log, line, clock
        self._said: dict[tuple[str, str], float] = {}

    def __call__(self, key: str, reason: str) -> bool:
        """Log a reason and return True, or count it as dropped and return False."""
        kind, now = (key, _DIGITS.sub("#", reason)), self._clock()
        if now - self._said.get(kind, -inf) < TELL_PERIOD or (kind not in self._said and len(self._said) >= MAX_KEYS):
            self.drops.add(key, reason)
            return False
        self._said[kind] = now
        self._log.warning(self._line, {"key": key, "reason": reason})
        self.drops.tell()
        return True
