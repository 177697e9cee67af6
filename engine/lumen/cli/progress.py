"""A progress bar with the estimated time left; it appears only on a terminal, and after two seconds."""

import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import NamedTuple, Protocol

from lumen.cli.printing import clock_time
from lumen.upkeep.threads import WatchedThread

PATIENCE = 2.0
"""The time [s] before the bar appears."""
REDRAWING = 0.25
"""The time between two drawings of the line [s], short enough that it visibly changes."""
WIDTH = 24


class ProgressListener(Protocol):
    """A function that is called with the amount done, the whole amount (0 if unknown), and the name of the work."""

    def __call__(self, done: float, whole: float, name: str) -> None: ...


class ProgressState(NamedTuple):
    """The last report of progress."""

    done: float = 0.0
    """The amount of work that is done, in the unit of `whole`."""
    whole: float = 0.0
    """The whole amount, or an upper bound of it; 0 if unknown."""
    name: str = ""
    """The name of the work; nothing is shown while it is empty."""
    at: float = 0.0
    """The time of the report since the beginning [s]."""


def progress_line(state: ProgressState, now: float, *, at_most: bool = False) -> str:
    """Return the line to show at `now` [s].

    The estimate assumes a constant speed, and counts down between two reports. With `at_most` it is marked as an upper
    bound.
    """
    if state.whole <= 0.0:
        return f"{state.name} ({clock_time(now)} so far)"
    share = min(state.done / state.whole, 1.0)
    bar = "#" * round(WIDTH * share)
    line = f"[{bar:<{WIDTH}}] {state.done:,.0f} of {'at most ' * at_most}{state.whole:,.0f} {state.name}"
    if share <= 0.0:
        return line
    left = state.at / share - now
    if left <= 0.0:  # the estimate was wrong: don't make up another one
        return f"{line}, {clock_time(now)} so far"
    return f"{line}, {'at most' if at_most else 'about'} {clock_time(round(left))} more"


@contextmanager
def progress(*, at_most: bool = False, clock: Callable[[], float] = time.monotonic) -> Iterator[ProgressListener]:
    """Show a progress bar on standard error until the block ends; yield the function that receives the progress.

    `at_most` is true if the whole amount is only an upper bound. Nothing is shown if standard error is not a terminal.
    """
    if not sys.stderr.isatty():
        yield lambda done, whole, name: None
        return
    began, told, over = clock(), [ProgressState()], threading.Event()

    def draw() -> None:
        while not over.wait(max(REDRAWING, began + PATIENCE - clock())):
            state = told[0]
            if state.name:
                shown = progress_line(state, clock() - began, at_most=at_most)
                print(f"\r\x1b[K{shown}", end="", file=sys.stderr, flush=True)

    def tell(done: float, whole: float, name: str) -> None:
        told[0] = ProgressState(done, whole, name, clock() - began)

    thread = WatchedThread("lumen-progress", draw)
    thread.start()
    try:
        yield tell
    finally:
        over.set()
        thread.join()
        print("\r\x1b[K", end="", file=sys.stderr, flush=True)
