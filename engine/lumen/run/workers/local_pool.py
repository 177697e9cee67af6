"""Processes of this machine as an executor; whatever ends the executor, no process or folder is left."""

import os
import shutil
import signal
import tempfile
import threading
from collections.abc import Iterator
from concurrent.futures import Executor, ProcessPoolExecutor
from contextlib import contextmanager
from multiprocessing import active_children, connection, get_context, parent_process
from pathlib import Path
from types import FrameType
from typing import Any, NoReturn

from lumen.upkeep.threads import WatchedThread

TERMINATED = 128 + signal.SIGTERM
"""The exit code after SIGTERM."""


@contextmanager
def local_pool(count: int, folder: Path) -> Iterator[Executor]:
    """Start `count` processes; an exception kills them without waiting for their tasks.

    The processes end with this one, even if it is killed, and then delete `folder`.
    """
    before = set(active_children())
    pool = ProcessPoolExecutor(count, get_context("spawn"), _begin, (str(folder),))
    try:
        with interrupts_blocked():
            pool.submit(os.getpid)  # this starts all of them
        yield pool
    except BaseException:
        for process in set(active_children()) - before:
            process.kill()
        raise
    finally:
        pool.shutdown(cancel_futures=True)


@contextmanager
def working_folder() -> Iterator[Path]:
    """Make a temporary folder, which is deleted at the end of the context.

    On the main thread, SIGTERM meanwhile ends the process like Ctrl-C, so that the folder is deleted.
    """
    handled = threading.current_thread() is threading.main_thread() and (
        signal.getsignal(signal.SIGTERM) is signal.SIG_DFL
    )
    folder = Path(tempfile.mkdtemp(prefix="lumen-work-"))
    if handled:
        signal.signal(signal.SIGTERM, _terminate)
    try:
        yield folder
    finally:
        shutil.rmtree(folder, ignore_errors=True)
        if handled:
            signal.signal(signal.SIGTERM, signal.SIG_DFL)


@contextmanager
def interrupts_blocked() -> Iterator[None]:
    """Delay Ctrl-C for this process, and block it in processes started meanwhile until they unblock it."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGINT])
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _terminate(number: int, frame: FrameType | None) -> NoReturn:
    raise SystemExit(TERMINATED)


def _begin(folder: str) -> None:
    """Prepare a worker: Ctrl-C ends it without output, and it ends with its parent process."""
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    if hasattr(signal, "pthread_sigmask"):
        signal.pthread_sigmask(signal.SIG_UNBLOCK, [signal.SIGINT])

    def end() -> Any:
        if parent := parent_process():
            connection.wait([parent.sentinel])
        shutil.rmtree(folder, ignore_errors=True)
        os._exit(1)

    WatchedThread("lumen-worker", end).start()
