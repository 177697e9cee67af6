"""A file whose tests leave a thread fails, and names it."""

import threading

import pytest

from tests.leftovers import none_left
from tests.waiting import finished


def test_a_thread_that_is_left_is_named() -> None:
    ended = threading.Event()
    left = threading.Thread(target=ended.wait, name="visitor", daemon=True)
    with pytest.raises(AssertionError, match="all threads that these tests began end") as raised, none_left(0.1):
        left.start()
    assert "visitor" in str(raised.value)
    ended.set()
    finished(left)


def test_one_that_ends_soon_is_awaited() -> None:
    ended = threading.Event()
    with none_left():
        threading.Thread(target=ended.wait).start()
        threading.Timer(0.1, ended.set).start()
