"""Pauses between attempts: each is twice as long as the one before, up to a limit."""

from math import inf

MAX_DOUBLINGS = 60
"""Limit of the doublings, far beyond any useful pause, so that the float does not overflow."""


def pause_after(failures: int, first: float, longest: float = inf) -> float:
    """Return the pause after a number of failures in a row [s]: `first` after one, 0 after none."""
    return min(first * 2.0 ** min(failures - 1, MAX_DOUBLINGS), longest) if failures > 0 else 0.0


class Backoff:
    """A counter of failures in a row, with the pause after each [s]."""

    def __init__(self, first: float, longest: float = inf) -> None:
        self._first, self._longest, self._failures = first, longest, 0

    def next(self) -> float:
        """Count a failure; return the pause after it [s]."""
        self._failures += 1
        return pause_after(self._failures, self._first, self._longest)

    def reset(self) -> None:
        """Note a success: the next pause is the first again."""
        self._failures = 0
