"""Control Python's garbage collection: none during short work, and none that delays the robot."""

import gc
from collections.abc import Iterator
from contextlib import contextmanager

NEVER = 2**31 - 1
"""A threshold of smaller collections that is never reached, so that Python begins no full collection."""

RARELY = 100_000
"""The number of new objects between two collections in a short-lived process, about 10 MB."""


@contextmanager
def gc_paused() -> Iterator[None]:
    """Pause garbage collection, for imports and short work: it would use a tenth of the time and find nothing."""
    before = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if before:
            gc.enable()


def search_rarely() -> None:
    """Collect garbage only after many new objects, for a short-lived process that mostly imports."""
    gc.set_threshold(RARELY)


class GcScheduler:
    """A scheduler of full collections. Call it after each tick, when the most time is left until the next.

    It stops Python from beginning full collections itself, at any moment and on any thread. Objects that exist when the
    scheduler is made are never searched again: with everything that was imported and loaded, a collection would last a
    tick or more; with later objects alone it lasts some milliseconds.
    """

    def __init__(self) -> None:
        gc.freeze()  # without a collection before: imports and loading leave almost no garbage
        self._usual = gc.get_threshold()
        gc.set_threshold(*self._usual[:2], NEVER)

    def __call__(self, _: float = 0.0) -> None:
        """Run a full collection if Python would have begun one since the last full collection."""
        if gc.get_count()[2] > self._usual[2]:
            gc.collect()

    def close(self) -> None:
        """Restore Python's usual thresholds."""
        gc.set_threshold(*self._usual)
