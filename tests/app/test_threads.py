"""A fault affects only the part it hits; its thread is restarted; if that is impossible, the robot rests."""

import logging
import threading
from collections import deque
from collections.abc import Iterator
from typing import Any

import pytest

from lumen.bus import Message, connect
from lumen.language.commands import Rest
from lumen.run.setup import set_up
from lumen.upkeep import threads
from lumen.upkeep.drops import MAX_KEYS, OTHERS, TELL_PERIOD, DropLog, Drops, ReasonLog
from lumen.upkeep.threads import MAX_FAULTS, MessageGuard, ThreadWatch, WatchedThread
from tests.exhibits import project
from tests.nodes import Printed, whole
from tests.rabbitmq import RabbitMQ
from tests.waiting import HANG, Collector, until

LOG = logging.getLogger("test")


@pytest.fixture(autouse=True)
def no_pause(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(threads, "FIRST_PAUSE", 0.0)


@pytest.fixture
def bus(broker: RabbitMQ) -> Iterator[Any]:
    bus = connect(broker.url)
    yield bus
    bus.close()


class Failing:
    """Work that fails `times` times, and then succeeds."""

    def __init__(self, times: int, error: BaseException) -> None:
        self.left, self.error, self.done = times, error, threading.Event()

    def __call__(self) -> None:
        self.left -= 1
        if self.left >= 0:
            raise self.error
        self.done.set()


@pytest.mark.parametrize("error", [ValueError("no number"), SystemExit(3), MemoryError()])
def test_what_fails_is_begun_again(error: BaseException, caplog: pytest.LogCaptureFixture) -> None:
    work = Failing(MAX_FAULTS - 1, error)
    thread = WatchedThread("a", work)
    thread.start()
    assert work.done.wait(HANG)
    assert thread.join(HANG)
    assert thread.lost == ""
    assert caplog.text.count("the thread `a` failed") == MAX_FAULTS - 1


def test_what_fails_again_and_again_is_given_up_and_told_once() -> None:
    work, watch = Failing(1_000, ValueError("no number")), ThreadWatch(lambda: 1.0)
    thread = WatchedThread("a", work, vital=True)
    thread.start()
    until(lambda: thread.lost)
    assert thread.lost == "the thread `a` failed 5 times within 60 s; the last error: ValueError('no number')"
    assert thread in watch.tick()
    watch._next = 0.0
    assert thread not in watch.tick()


def test_a_thread_that_died_without_a_word_is_begun_again() -> None:
    begun, go = list[int](), threading.Event()

    def work() -> None:
        begun.append(1)
        go.wait(HANG)

    thread = WatchedThread("a", work)
    thread.start()
    until(lambda: begun)
    dead = threading.Thread(target=lambda: None)
    dead.start()
    dead.join()
    living, thread._thread = thread._thread, dead
    ThreadWatch().tick()
    until(lambda: len(begun) == 2)
    go.set()
    assert living
    living.join(HANG)
    assert thread.join(HANG)
    ThreadWatch().tick()
    assert len(begun) == 2, "what has ended is not begun again"


def test_nobody_begins_a_thread_again_whose_owner_has_ended_it() -> None:
    asked, go = list[int](), threading.Event()

    def work() -> None:
        asked.append(1)
        go.wait(HANG)
        raise ValueError

    thread = WatchedThread("a", work)
    thread.start()
    until(lambda: asked)
    assert not thread.join(0.0)
    go.set()
    assert thread.join(HANG)
    assert len(asked) == 1


def test_a_handler_that_kills_its_thread_costs_its_message(bus: Any, caplog: pytest.LogCaptureFixture) -> None:
    seen, thread = Collector(), bus._transport.dispatcher._thread

    def handle(message: Message) -> None:
        if message.body == "poison":
            raise SystemExit("enough")
        seen(message)

    bus.subscribe("lumen.killing", handle)
    for body in ("first", "poison", "second"):
        bus.publish("lumen.killing", body)
    assert seen.wait(2) == ["first", "second"]
    assert thread.is_alive()
    assert "the thread `lumen-bus-handlers` failed" in caplog.text


def test_a_fault_of_ours_with_a_message_costs_that_message(bus: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    seen, dispatcher = Collector(), bus._transport.dispatcher
    usual = dispatcher._deliver

    def deliver(subscription: Any, delivery: Any) -> None:
        if delivery.body == b"1":
            raise TypeError("startswith first arg must be bytes")
        usual(subscription, delivery)

    monkeypatch.setattr(dispatcher, "_deliver", deliver)
    bus.subscribe("lumen.faulty", seen)
    for n in range(3):
        bus.publish("lumen.faulty", n)
    assert seen.wait(2) == [0, 2]
    assert dispatcher.guard.drops.counts == {"lumen.faulty": 1}


def test_a_connection_whose_thread_is_killed_comes_back(bus: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    consumer, seen = bus._transport.consumer, Collector()
    bus.subscribe("lumen.again", seen)
    usual, killed = consumer.process, threading.Event()

    def process(seconds: float) -> None:
        if not killed.is_set():
            killed.set()
            raise SystemExit
        usual(seconds)

    monkeypatch.setattr(consumer, "process", process)
    bus.publish("lumen.again", 1)
    assert killed.wait(HANG)
    until(lambda: consumer.connection and all(s.epoch == consumer._epoch == 2 for s in consumer.subscriptions()))
    bus.publish("lumen.again", 2)
    until(lambda: seen.bodies[-1:] == [2])


def test_a_robot_that_nobody_could_stop_any_more_rests(capsys: pytest.CaptureFixture[str]) -> None:
    exhibit = project()
    setup = set_up("recording", exhibit, "max")
    robot: Any = setup.robot
    exhibition = whole(exhibit, setup, narrator=Printed(setup.clock.now, lambda: exhibit.machine))
    exhibition.start()
    spare, vital = (
        WatchedThread(name, Failing(1_000, ValueError()), vital=name == "ears") for name in ("eyes", "ears")
    )
    for thread in (spare, vital):
        thread.start()
        until(lambda: thread.lost)  # noqa: B023
        exhibition.node._threads._next = 0.0
        for _ in range(3):
            exhibition.tick()
        rested = [command for _, command in robot.performed if isinstance(command, Rest)]
        assert bool(rested) == thread.vital
    said = capsys.readouterr().out
    assert "trouble  the thread `eyes` failed 5 times" in said
    assert "robot    rests, because no person could stop it any more: the thread `ears` failed 5 times" in said
    exhibition.close()


def test_a_guard_counts_by_key_and_shows_where_a_fault_was_once(caplog: pytest.LogCaptureFixture) -> None:
    guard = MessageGuard(LOG, "the test")
    for key in ("a", "a", "b"):
        with guard(key):
            raise KeyError("x")
    assert guard.drops.counts == {"a": 2, "b": 1}
    assert caplog.text.count("Traceback") == 2


def test_drops_are_told_at_once_then_every_ten_seconds_with_their_key(caplog: pytest.LogCaptureFixture) -> None:
    now = 0.0
    drops = DropLog(LOG, clock=lambda: now)
    for _ in range(3):
        drops.add("face", "too many")
    drops.tell()
    now = TELL_PERIOD
    drops.tell()
    drops.add("face", "too many")
    drops.tell(all=True)
    assert [record.getMessage() for record in caplog.records] == [
        "messages on `face` are dropped: too many",
        "more messages on `face` were dropped (2 in 10 s): too many",
        "more messages on `face` were dropped (1 in 0 s): too many",
    ]
    for n in range(2 * MAX_KEYS):
        drops.add(f"key {n}", "too many")
    assert len(drops.counts) == MAX_KEYS + 1
    assert drops.counts[OTHERS] == MAX_KEYS + 1


def test_what_gives_way_in_a_full_queue_is_counted_by_its_key() -> None:
    drops, waiting = DropLog(LOG), deque[tuple[str, int]](maxlen=2)
    for n, key in enumerate("aabc"):
        drops.push(waiting, (key, n), lambda old: old[0], "full")
    assert list(waiting) == [("b", 2), ("c", 3)]
    assert drops.counts == {"a": 2}


def test_what_another_thread_takes_out_of_a_full_queue_meanwhile_is_not_counted() -> None:
    waiting, taken = deque(["a"], maxlen=1), list[str]()

    def take(line: str) -> None:
        taken.extend(waiting)
        waiting.clear()

    drops = Drops(take)
    drops.push(waiting, "b", str, "full")
    assert sorted([*taken, *waiting, *drops.counts]) == ["a", "b"]


def test_a_reason_is_told_once_in_ten_seconds_whatever_its_numbers(caplog: pytest.LogCaptureFixture) -> None:
    now = 0.0
    said = ReasonLog(LOG, "on `%(key)s`: %(reason)s", clock=lambda: now)
    told = [said(*what) for what in (("a", "3 wait"), ("a", "4 wait"), ("b", "4 wait"), ("a", "too late"))]
    now = TELL_PERIOD
    told.append(said("a", "5 wait"))
    assert told == [True, False, True, True, True]
    assert [record.getMessage() for record in caplog.records] == [
        "on `a`: 3 wait",
        "messages on `a` are dropped: 4 wait",
        "on `b`: 4 wait",
        "on `a`: too late",
        "on `a`: 5 wait",
    ]
