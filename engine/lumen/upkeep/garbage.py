"""Python's search for garbage, left out where it would not pay, and kept from stopping the robot."""

import gc
from collections.abc import Iterator
from contextlib import contextmanager

NEVER = 2**31 - 1
"""After how many smaller searches Python begins a full one, where it is to begin none."""

RARELY = 100_000
"""The number of new objects between two searches in a short-lived process: about 10 MB."""


@contextmanager
def gc_paused() -> Iterator[None]:
    """No garbage is searched for within: for imports and short work, of which it takes a tenth and finds nothing."""
    before = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if before:
            gc.enable()


def search_rarely() -> None:
    """Search for garbage only after many new objects: for a short-lived process, most of whose time is imports."""
    gc.set_threshold(RARELY)


class GcScheduler:
    """Called after each tick, when there is most time until the next: looks for garbage where a search is due.

    What is there when it is made is never looked through again, and Python begins no full search of its own, in
    whatever moment and thread: one through all that was imported and loaded takes a tick and more, one through what
    came after some milliseconds. `close` gives that back.
    """

    def __init__(self) -> None:
        gc.freeze()  # not after a search: what imports and loading leave behind is next to nothing
        self._usual = gc.get_threshold()
        gc.set_threshold(*self._usual[:2], NEVER)

    def __call__(self, _: float = 0.0) -> None:
        if gc.get_count()[2] > self._usual[2]:
            gc.collect()

    def close(self) -> None:
        gc.set_threshold(*self._usual)
