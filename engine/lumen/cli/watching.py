"""`lumen lint --watch`: print the findings again whenever a file is saved."""

import queue
import sys
import time
from collections.abc import Callable, Sequence
from contextlib import ExitStack

from lumen.cli.printing import show, verdict
from lumen.cli.render import render
from lumen.cli.terminal import coloured, paint
from lumen.run.asking import LOOK
from lumen.run.linting.findings import Findings
from lumen.run.linting.targets import FindingsOf, LintTarget
from lumen.run.watcher import FileWatcher, SavedFiles
from lumen.upkeep.garbage import GcScheduler, gc_paused

QUIET = 0.01
"""The time that files must be unchanged before they are read [s]: a half-written file would have false findings."""

_CLEAR = "\x1b[2J\x1b[H"


def watch(projects: Sequence[LintTarget], judge: FindingsOf, format: str) -> int:
    """Print the findings, and print them again after every change, until Ctrl-C is pressed; return 0.

    Ctrl-C before the first printing raises KeyboardInterrupt.
    """
    changes: queue.SimpleQueue[tuple[int, SavedFiles]] = queue.SimpleQueue()
    found = [judge(what) for what in projects]
    with ExitStack() as stack:
        for i, what in enumerate(projects):
            watcher = FileWatcher(what.root, found[i].files, _into(changes, i), quiet=QUIET)
            stack.callback(watcher.close)
            watcher.start()
        try:
            _draw(found, format)
            gc_scheduler = GcScheduler()
            stack.callback(gc_scheduler.close)
            while True:
                try:
                    latest = dict([changes.get(timeout=LOOK)])
                except queue.Empty:
                    continue
                while not changes.empty():
                    latest.update([changes.get()])
                with gc_paused():
                    for i, saved in latest.items():
                        found[i] = judge(projects[i], saved.files)
                    _draw(found, format, time.monotonic() - min(saved.seen for saved in latest.values()))
                gc_scheduler()
        except KeyboardInterrupt:
            if sys.stdout.isatty():
                print()
    return 0


def _into(changes: "queue.SimpleQueue[tuple[int, SavedFiles]]", project: int) -> Callable[[SavedFiles], None]:
    """Return a watcher's callback that passes the saved files of a project to the thread that prints."""
    return lambda saved: changes.put((project, saved))


def _draw(found: Sequence[Findings], format: str, took: float | None = None) -> None:
    """Print the findings: on a terminal in place of the previous ones, otherwise below them."""
    on = coloured()
    clear = _CLEAR if sys.stdout.isatty() else ""
    answered = f" in {took * 1000:.0f} ms" if took is not None else ""
    sign = paint("wrong", "bold", "red", on=on) if verdict(found) else paint("right", "bold", "green", on=on)
    waits = paint(f"{answered}; waiting for the next change, Ctrl-C ends", "dim", on=on)
    show(f"{clear}{render(format, found, coloured=on)}\n\n{time.strftime('%H:%M:%S')} {sign}{waits}")
