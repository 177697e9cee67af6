"""How far something long is, and about how long it still takes: on a terminal only, and after two seconds."""

import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import NamedTuple, Protocol

from lumen.cli.printing import clock_time
from lumen.upkeep.threads import WatchedThread

PATIENCE = 2.0
"""How long nothing is shown [s]."""
REDRAWING = 0.25
"""How often the line is drawn anew [s], so that one sees that it lives."""
WIDTH = 24


class ProgressListener(Protocol):
    """Told how much is done, of how much (0 where nobody knows), and of what."""

    def __call__(self, done: float, whole: float, name: str) -> None: ...


class ProgressState(NamedTuple):
    """What was told last, and when, counted from the beginning [s]."""

    done: float = 0.0
    whole: float = 0.0
    name: str = ""
    at: float = 0.0


def progress_line(state: ProgressState, now: float, *, at_most: bool = False) -> str:
    """What is shown `now` [s]: the estimate takes what is left to go on as what is done did, and counts down."""
    if state.whole <= 0.0:
        return f"{state.name} ({clock_time(now)} so far)"
    share = min(state.done / state.whole, 1.0)
    bar = "#" * round(WIDTH * share)
    line = f"[{bar:<{WIDTH}}] {state.done:,.0f} of {'at most ' * at_most}{state.whole:,.0f} {state.name}"
    if share <= 0.0:
        return line
    left = state.at / share - now
    if left <= 0.0:  # the estimate was wrong: no other one is made up
        return f"{line}, {clock_time(now)} so far"
    return f"{line}, {'at most' if at_most else 'about'} {clock_time(round(left))} more"


@contextmanager
def progress(*, at_most: bool = False, clock: Callable[[], float] = time.monotonic) -> Iterator[ProgressListener]:
    """What takes how far it is; of the line nothing is left at the end. `at_most`: the whole is a bound."""
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
