"""Promises of the embedded bus only: it has no thread, and delivery is complete when `publish` returns."""

import threading
from collections.abc import Callable

import pytest

from lumen.bus import Bus, Message, connect
from lumen.bus.memory import MemoryBus
from tests.waiting import HANG, Collector, threads, until


def test_everything_is_delivered_when_publish_returns() -> None:
    bus, order = connect("memory://"), []
    before = threads()
    bus.subscribe("lumen.*", lambda m: order.append(m.body) or (m.body < 5 and bus.publish("lumen.a", m.body + 1)))
    bus.publish("lumen.a", 0)
    assert order == [0, 1, 2, 3, 4, 5]
    assert threads() <= before


def test_a_long_chain_of_messages_is_no_recursion() -> None:
    bus, seen = connect("memory://"), Collector()

    def next_one(message: Message) -> None:
        seen(message)
        if message.body < 20_000:
            bus.publish("lumen.a", message.body + 1)

    bus.subscribe("lumen.a", next_one)
    bus.publish("lumen.a", 0)
    assert len(seen.messages) == 20_001


def test_a_publisher_on_another_thread_does_not_wait_for_a_handler() -> None:
    bus, seen = connect("memory://"), Collector()
    inside, release = threading.Event(), threading.Event()

    def slow(message: Message) -> None:
        seen(message)
        inside.set()
        assert release.wait(HANG)

    bus.subscribe("lumen.a", slow)
    thread = threading.Thread(target=bus.publish, args=("lumen.a", 1))
    thread.start()
    assert inside.wait(HANG)
    bus.publish("lumen.a", 2)
    assert seen.bodies == [1]
    release.set()
    assert seen.wait(2) == [1, 2]
    thread.join()


def test_who_subscribes_later_is_not_told_what_was_published_before() -> None:
    bus, late = connect("memory://"), Collector()

    def handler(message: Message) -> None:
        bus.publish("lumen.b", 1)
        bus.subscribe("lumen.b", late)

    bus.subscribe("lumen.a", handler)
    bus.publish("lumen.a", 0)
    assert late.bodies == []


def test_who_has_unsubscribed_is_not_told_what_is_being_delivered() -> None:
    bus, heard = connect("memory://"), list[str]()
    undo = list[Callable[[], None]]()

    def first(message: Message) -> None:
        heard.append("first")
        undo[1]()

    undo += [bus.subscribe("lumen.a", handler) for handler in (first, lambda _: heard.append("second"))]
    bus.subscribe("lumen.a", lambda _: heard.append("third"))
    bus.publish("lumen.a", 0)
    assert heard == ["first", "third"]


def test_buses_without_a_name_are_strangers_and_a_name_is_shared(address: str) -> None:
    seen = Collector()
    connect("memory://").subscribe("lumen.a", seen)
    one, other = connect(address), connect(address)
    one.subscribe("lumen.a", seen)
    connect("memory://").publish("lumen.a", "private")
    other.publish("lumen.a", "shared")
    assert seen.bodies == ["shared"]


def flooded(bus: Bus, count: int) -> None:
    """Publish `count` numbers while a subscriber on another thread blocks the bus; return after it has continued."""
    inside, release = threading.Event(), threading.Event()

    def slow(message: Message) -> None:
        inside.set()
        assert release.wait(HANG)

    undo = bus.subscribe("lumen.slow", slow)
    thread = threading.Thread(target=bus.publish, args=("lumen.slow", None))
    thread.start()
    assert inside.wait(HANG)
    for i in range(count):
        bus.publish("lumen.a", i)
    release.set()
    thread.join()
    undo()


@pytest.mark.slow
def test_what_waits_is_bounded_and_the_newest_stay(caplog: pytest.LogCaptureFixture) -> None:
    bus, seen = connect("memory://"), Collector()
    assert isinstance(bus, MemoryBus)
    bus._hub.drops._clock = lambda: 0.0
    bus.subscribe("lumen.a", seen)
    flooded(bus, 100_025)
    assert seen.bodies == list(range(25, 100_025))
    assert [record.getMessage() for record in caplog.records] == [
        "messages on `lumen.a` are dropped: 100,000 messages are waiting for a subscriber already",
        "more messages on `lumen.a` were dropped (24 in 0 s): 100,000 messages are waiting for a subscriber already",
    ]
    bus.publish("lumen.a", "after")
    assert seen.bodies[-1] == "after"


def test_closing_is_not_dropped_with_what_waits(address: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("lumen.bus.memory.MAX_QUEUED_MESSAGES", 10)
    one, other, seen = connect(address), connect(address), Collector()
    one.subscribe("lumen.a", seen)
    ended, inside = threading.Thread(target=one.close), threading.Event()

    def slow(message: Message) -> None:
        ended.start()
        until(lambda: other._hub.queue)  # type: ignore[attr-defined]
        for i in range(50):
            other.publish("lumen.a", i)
        inside.set()

    other.subscribe("lumen.slow", slow)
    other.publish("lumen.slow", None)
    ended.join(HANG)
    assert not ended.is_alive()
    assert inside.is_set()
    assert seen.bodies == list(range(41, 50))
    assert not one._mine  # type: ignore[attr-defined]


def test_coming_and_going_leaves_nothing_behind() -> None:
    bus = connect("memory://")
    for _ in range(100):
        bus.subscribe("lumen.a", Collector())()
    assert not bus._mine  # type: ignore[attr-defined]
    assert not bus._hub.subscriptions  # type: ignore[attr-defined]


@pytest.mark.slow
def test_a_flood_of_keys_fills_no_memory() -> None:
    bus, seen = connect("memory://"), Collector()
    bus.subscribe("lumen.#", seen)
    for i in range(10_000):
        bus.publish(f"lumen.{i}", i)
    assert len(seen.messages) == 10_000
    assert len(bus._hub.listeners) <= 4_096  # type: ignore[attr-defined]
