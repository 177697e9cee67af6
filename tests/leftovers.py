"""No thread outlives the file of tests that began it: it could change what later tests find, or log a message there."""

import threading
from collections.abc import Iterator
from contextlib import contextmanager

import pytest

from tests.waiting import HANG, threads, until


@contextmanager
def none_left(timeout: float = HANG) -> Iterator[None]:
    """Wait at the end until all threads that begin meanwhile have ended; fail after `timeout` [s]."""
    before = threads()
    yield

    def left() -> list[str]:
        """Return the names of the new threads, but for those of libraries, and the timer of the idle process."""
        own = (each for each in threads() - before if not isinstance(each, threading._DummyThread | threading.Timer))
        return [each.name for each in own]

    until(lambda: not left(), timeout, what="all threads that these tests began end", shown=lambda: str(left()))


@pytest.fixture(scope="module", autouse=True)
def no_thread_left() -> Iterator[None]:
    with none_left():
        yield
