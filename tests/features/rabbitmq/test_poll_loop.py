"""One thread runs the loop, which calls the requests of other threads, and timers that are due."""

import threading
from collections.abc import Iterator
from selectors import EVENT_READ, EVENT_WRITE
from socket import socketpair
from types import SimpleNamespace

import pytest

from lumen.features.rabbitmq import poll_loop
from lumen.features.rabbitmq.poll_loop import PollLoop
from tests.waiting import finished, until


@pytest.fixture
def loop() -> Iterator[PollLoop]:
    loop = PollLoop()
    yield loop
    loop.close()


def turned(loop: PollLoop, seconds: float = 10.0) -> None:
    loop.call(loop.wait(seconds))


def test_what_another_thread_asks_for_ends_the_waiting_and_is_called_here(loop: PollLoop) -> None:
    called: list[int] = []
    thread = threading.Thread(target=lambda: loop.add_callback(lambda: called.append(threading.get_ident())))
    thread.start()
    until(lambda: called, meanwhile=lambda: turned(loop))
    finished(thread)
    turned(loop, 0.0)
    assert called == [threading.get_ident()]
    assert loop.wait(0.0) == [], "nothing wakes it any more"


def test_a_callback_that_asks_again_is_called_in_the_next_turn(loop: PollLoop) -> None:
    called: list[str] = []

    def first() -> None:
        called.append("first")
        loop.add_callback(lambda: called.append("second"))

    loop.add_callback(first)
    turned(loop)
    assert called == ["first"]
    turned(loop)
    assert called == ["first", "second"]


def test_timers_are_called_in_their_order_and_not_when_they_were_removed(
    loop: PollLoop, monkeypatch: pytest.MonkeyPatch
) -> None:
    now = 100.0
    monkeypatch.setattr(poll_loop, "time", SimpleNamespace(monotonic=lambda: now))
    called: list[str] = []
    loop.call_later(2.0, lambda: called.append("late"))
    removed = loop.call_later(0.0, lambda: called.append("removed"))
    loop.call_later(1.0, lambda: called.append("soon"))
    loop.remove_timeout(removed)
    loop.remove_timeout(removed)
    for now, due in ((101.0, ["soon"]), (102.0, ["soon", "late"])):  # noqa: B007  `now` is what the clock shows
        turned(loop)
        assert called == due


def test_a_timer_that_was_removed_ends_no_waiting(loop: PollLoop) -> None:
    called: list[str] = []
    removed = [loop.call_later(0.0, lambda: called.append("removed")) for _ in range(3)]
    loop.call_later(0.05, lambda: called.append("due"))
    for timer in reversed(removed):
        loop.remove_timeout(timer)
    turned(loop)
    assert called == ["due"], "one turn: nothing else woke it"


def test_sockets_are_watched_for_what_is_asked(loop: PollLoop) -> None:
    here, there = socketpair()
    told: list[int] = []
    loop.add_handler(here.fileno(), lambda fd, events: told.append(events), EVENT_READ)
    assert loop.wait(0.0) == []
    loop.update_handler(here.fileno(), EVENT_READ | EVENT_WRITE)
    turned(loop, 0.0)
    there.send(b"x")
    events = loop.wait(10.0)
    loop.remove_handler(here.fileno())
    loop.call(events)
    assert told == [EVENT_WRITE], "what was removed meanwhile is not called"
    here.close()
    there.close()


def test_whoever_asks_after_the_end_asks_nobody(loop: PollLoop) -> None:
    other = PollLoop()
    other.close()
    other.add_callback(lambda: None)
