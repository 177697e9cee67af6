"""Control Python's garbage collection: none during short work, and none that delays the robot."""

import gc
from collections.abc import Iterator
from contextlib import contextmanager
from typing import ClassVar

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
    first scheduler of a process is made are never searched again: with everything that was imported and loaded, a
    collection would last a tick or more; with later objects alone it lasts some milliseconds.
    """

    _froze = False
    _open: ClassVar[set["GcScheduler"]] = set()
    _usual = (0, 0, 0)
    """Python's thresholds before the schedulers that are open."""

    def __init__(self) -> None:
        if not self._froze:  # a second time would keep what earlier runs of this process have left
            GcScheduler._froze = True
            gc.freeze()  # without a collection before: imports and loading leave almost no garbage
        if not self._open:
            GcScheduler._usual = gc.get_threshold()
        self._open.add(self)
        gc.set_threshold(*self._usual[:2], NEVER)

    def __call__(self, _: float = 0.0) -> None:
        """Run a full collection if Python would have begun one since the last full collection."""
        if gc.get_count()[2] > self._usual[2]:
            gc.collect()

    def close(self) -> None:
        """Restore Python's usual thresholds, unless another scheduler of the process is open."""
        self._open.discard(self)
        if not self._open:
            gc.set_threshold(*self._usual)
