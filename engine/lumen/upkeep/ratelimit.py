"""Limit the frequency of events: messages per second by key, attempts after failures, and lines of a log."""

import logging
import time
from collections import OrderedDict
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from math import inf

MAX_DOUBLINGS = 60
"""The maximum number of doublings of a pause, so that the float does not overflow."""


def pause_after(failures: int, first: float, longest: float = inf) -> float:
    """Return the pause after a number of failures in a row [s].

    It is 0 after none, `first` after one, and doubles with each further failure, up to `longest`.
    """
    return min(first * 2.0 ** min(failures - 1, MAX_DOUBLINGS), longest) if failures > 0 else 0.0


class Backoff:
    """A counter of failures in a row, which computes the pause after each; see `pause_after`."""

    def __init__(self, first: float, longest: float = inf) -> None:
        self._first, self._longest, self._failures = first, longest, 0

    def next(self) -> float:
        """Count a failure; return the pause after it [s]."""
        self._failures += 1
        return pause_after(self._failures, self._first, self._longest)

    def reset(self) -> None:
        """Record a success, after which the pauses begin with the first again."""
        self._failures = 0


BURST = 5.0
"""The length of silence whose unused messages may all come at once [s]; a longer silence allows no more."""
MAX_KEYS = 10_000
"""The maximum number of keys that are counted at a time: those used last."""
MAX_SENDERS = 16
"""The maximum number of a key's senders that are counted separately at a time; further ones are counted together."""


@dataclass(slots=True)
class TokenBucket:
    """The tokens of a token bucket: `tokens` were left at the time `since` [s]. All times are of one clock."""

    tokens: float
    since: float

    def wait(self, now: float, rate: float, most: float) -> float:
        """Return the time from `now` until a token is available [s]; 0 if one is available.

        Tokens since the last call are added first: `rate` per second, up to `most`. The caller may remove an available
        token.
        """
        self.tokens, self.since = min(most, self.tokens + rate * (now - self.since)), now
        return 0.0 if self.tokens >= 1.0 else (1.0 - self.tokens) / rate


class RateLimiter:
    """A token bucket for each key: after a silence, as many messages as otherwise in BURST [s] may come at once."""

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self._buckets: OrderedDict[str, TokenBucket] = OrderedDict()
        self._senders: dict[str, dict[str, float]] = {}

    def apart(self, key: str, sender: str) -> str:
        """Return the key for `wait` under which a sender's messages are counted.

        The key is the sender's own, unless MAX_SENDERS others have sent within BURST [s].
        """
        if len(self._senders) > MAX_KEYS:
            self._senders.clear()
        now, senders = self._clock(), self._senders.setdefault(key, {})
        if sender not in senders and len(senders) >= MAX_SENDERS:
            for quiet in [name for name, last in senders.items() if now - last > BURST]:
                del senders[quiet]
            if len(senders) >= MAX_SENDERS:
                return key
        senders[sender] = now
        return f"{key} {sender}"

    def wait(self, key: str, rate: float) -> float:
        """Count a message and return 0 if the key allows it at `rate` per second; else return the time to wait [s].

        `rate` must be above 0.
        """
        now, most = self._clock(), max(BURST * rate, 1.0)
        if (bucket := self._buckets.get(key)) is None:
            bucket = self._buckets[key] = TokenBucket(most, now)
            if len(self._buckets) > MAX_KEYS:
                self._buckets.popitem(last=False)
        else:
            self._buckets.move_to_end(key)
        if left := bucket.wait(now, rate, most):
            return left
        bucket.tokens -= 1.0
        return 0.0


MAX_LINES = 1_000
"""The maximum number of different lines that are logged; further ones are dropped."""


class OnceLog:
    """Logs each line once, as a warning."""

    def __init__(self, log: logging.Logger) -> None:
        self._log = log
        self._lines: set[str] = set()

    def __call__(self, lines: Iterable[str]) -> None:
        for line in lines:
            if line not in self._lines and len(self._lines) < MAX_LINES:
                self._lines.add(line)
                self._log.warning("%s", line)
