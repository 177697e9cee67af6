"""What only the embedded bus promises: no thread, and done when `publish` returns."""

import threading

from lumen.bus import Message, connect
from tests.waiting import Collector


def test_everything_is_delivered_when_publish_returns() -> None:
    bus, order = connect("memory://"), []
    before = threading.active_count()
    bus.subscribe("lumen.*", lambda m: order.append(m.body) or (m.body < 5 and bus.publish("lumen.a", m.body + 1)))
    bus.publish("lumen.a", 0)
    assert order == [0, 1, 2, 3, 4, 5]
    assert threading.active_count() == before


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
        assert release.wait(20)

    bus.subscribe("lumen.a", slow)
    thread = threading.Thread(target=bus.publish, args=("lumen.a", 1))
    thread.start()
    assert inside.wait(20)
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


def test_buses_without_a_name_are_strangers_and_a_name_is_shared() -> None:
    seen = Collector()
    connect("memory://").subscribe("lumen.a", seen)
    one, other = connect("memory://hall"), connect("memory://hall")
    one.subscribe("lumen.a", seen)
    connect("memory://").publish("lumen.a", "private")
    other.publish("lumen.a", "shared")
    assert seen.bodies == ["shared"]


def test_a_flood_of_keys_fills_no_memory() -> None:
    bus, seen = connect("memory://"), Collector()
    bus.subscribe("lumen.#", seen)
    for i in range(10_000):
        bus.publish(f"lumen.{i}", i)
    assert len(seen.messages) == 10_000
    assert len(bus._hub.listeners) <= 4_096  # type: ignore[attr-defined]
