"""Promises of every bus, tested with each of them."""

import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from lumen.bus import BusError, Message, Refused, connect
from lumen.bus.local import LocalBusClient, LocalBusServer
from lumen.language.causes import MessageOrigin
from lumen.language.routes import Carried, Direction, Route
from lumen.ports import Bus
from tests.waiting import HANG, Collector

pytestmark = pytest.mark.usefixtures("patient_bus")

KINDS = ["memory", "local", pytest.param("amqp", marks=pytest.mark.broker)]

Connect = Callable[[], Bus]


@pytest.fixture(params=KINDS)
def another(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[Connect]:
    """A function that makes handles on one bus."""
    if request.param == "amqp":
        broker = request.getfixturevalue("broker")
        yield lambda: connect(broker.url)
    elif request.param == "memory":
        first = connect(f"memory://{tmp_path}")
        yield lambda: connect(f"memory://{tmp_path}")
        first.close()
    else:
        inside = connect("memory://")
        server = LocalBusServer(inside, tmp_path)
        yield lambda: LocalBusClient(server.address)
        server.close()
        inside.close()


@pytest.fixture
def bus(another: Connect) -> Iterator[Bus]:
    bus = another()
    yield bus
    bus.close()


def test_messages_come_in_the_order_published(bus: Bus) -> None:
    seen = Collector()
    bus.subscribe("lumen.a", seen)
    for i in range(500):
        bus.publish("lumen.a", i)
    assert seen.wait(500) == list(range(500))


def test_a_subscription_is_active_when_subscribe_returns(bus: Bus) -> None:
    for i in range(20):
        seen = Collector()
        undo = bus.subscribe(f"lumen.at.{i}", seen)
        bus.publish(f"lumen.at.{i}", i)
        assert seen.wait(1) == [i]
        undo()


@pytest.mark.parametrize(
    ("pattern", "keys"),
    [
        ("lumen.visual.face", ["lumen.visual.face"]),
        ("lumen.*.face", ["lumen.visual.face"]),
        ("lumen.#", ["lumen", "lumen.visual", "lumen.visual.face"]),
        ("#.face", ["lumen.visual.face", "face"]),
        ("*.*", ["lumen.visual"]),
        ("#", ["lumen", "lumen.visual", "lumen.visual.face", "face"]),
    ],
)
def test_wildcards_stand_for_words(bus: Bus, pattern: str, keys: list[str]) -> None:
    seen, last = Collector(), Collector()
    bus.subscribe(pattern, seen)
    bus.subscribe("end", last)
    for key in ["lumen", "lumen.visual", "lumen.visual.face", "face"]:
        bus.publish(key, key)
    bus.close()
    assert seen.bodies == keys


def test_one_handler_runs_at_a_time(bus: Bus) -> None:
    inside, overlaps, seen = threading.Lock(), [], Collector()

    def handler(message: Message) -> None:
        if not inside.acquire(blocking=False):
            overlaps.append(message.key)
            return
        seen(message)
        inside.release()

    bus.subscribe("lumen.a", handler)
    bus.subscribe("lumen.*", handler)
    threads = [threading.Thread(target=lambda: [bus.publish("lumen.a", i) for i in range(100)]) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    seen.wait(800)
    assert not overlaps


def test_every_publisher_keeps_its_own_order(bus: Bus) -> None:
    seen = Collector()
    bus.subscribe("lumen.*", seen)
    threads = [
        threading.Thread(target=lambda t=t: [bus.publish(f"lumen.t{t}", i) for i in range(200)]) for t in range(4)
    ]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    seen.wait(800)
    for t in range(4):
        assert [m.body for m in seen.messages if m.key == f"lumen.t{t}"] == list(range(200))


def test_a_handler_may_publish_and_is_done_before_its_message_is_handed_on(bus: Bus) -> None:
    order: list[str] = []
    seen = Collector()

    def first(message: Message) -> None:
        order.append("first begins")
        bus.publish("lumen.b", message.body)
        order.append("first ends")

    def second(message: Message) -> None:
        order.append("second")
        seen(message)

    bus.subscribe("lumen.a", first)
    bus.subscribe("lumen.b", second)
    bus.publish("lumen.a", 1)
    seen.wait(1)
    assert order == ["first begins", "first ends", "second"]


def test_a_handler_may_subscribe(bus: Bus) -> None:
    seen = Collector()

    def handler(message: Message) -> None:
        bus.subscribe("lumen.b", seen)
        bus.publish("lumen.b", "later")

    bus.subscribe("lumen.a", handler)
    bus.publish("lumen.a", None)
    assert seen.wait(1) == ["later"]


def test_after_unsubscribing_nothing_comes(bus: Bus) -> None:
    seen, others = Collector(), Collector()
    undo = bus.subscribe("lumen.a", seen)
    bus.subscribe("lumen.a", others)
    bus.publish("lumen.a", 1)
    seen.wait(1)
    undo()
    undo()
    bus.publish("lumen.a", 2)
    assert others.wait(2) == [1, 2]
    assert seen.bodies == [1]


def test_an_exception_in_a_handler_is_logged_and_ends_nothing(bus: Bus, caplog: pytest.LogCaptureFixture) -> None:
    seen = Collector()

    def handler(message: Message) -> None:
        raise ValueError("a fault in a module")

    bus.subscribe("lumen.a", handler)
    bus.subscribe("lumen.a", seen)
    bus.publish("lumen.a", 1)
    bus.publish("lumen.a", 2)
    assert seen.wait(2) == [1, 2]
    bus.close()
    assert caplog.text.count("ValueError: a fault in a module") == 2


def test_what_one_side_does_with_a_body_is_not_seen_by_another(bus: Bus) -> None:
    seen = Collector()

    def spoil(message: Message) -> None:
        message.body["list"].append("spoilt")

    bus.subscribe("lumen.a", spoil)
    bus.subscribe("lumen.a", seen)
    body = {"list": [1, {"x": 2}]}
    bus.publish("lumen.a", body)
    body["list"].append("changed after publishing")
    assert seen.wait(1) == [{"list": [1, {"x": 2}]}]
    assert body["list"][-1] == "changed after publishing"


BODIES: list[Any] = [
    None, True, 0, -1.5, 2**53, "", "selamat pagi – 你好 🤖 \u0000", [], {}, [None, [1, {"": {}}]],
    {"x": 160, "y": 120.5, "nested": {"a": [1, 2, "ü"]}, "Method": "moveTo"},
]  # fmt: skip


def test_bodies_arrive_as_they_were(bus: Bus) -> None:
    seen = Collector()
    bus.subscribe("lumen.a", seen)
    for body in BODIES:
        bus.publish("lumen.a", body)
    assert seen.wait(len(BODIES)) == BODIES
    assert [type(b) for b in seen.bodies] == [type(b) for b in BODIES]


def test_a_tuple_arrives_as_a_list(bus: Bus) -> None:
    seen = Collector()
    bus.subscribe("lumen.a", seen)
    bus.publish("lumen.a", {"angle": (0.1, 0.2)})
    assert seen.wait(1) == [{"angle": [0.1, 0.2]}]


def test_a_big_body_arrives(bus: Bus) -> None:
    seen = Collector()
    bus.subscribe("lumen.a", seen)
    bus.publish("lumen.a", {"contentUrl": "x" * 900_000})
    assert len(seen.wait(1)[0]["contentUrl"]) == 900_000


def _nested(depth: int) -> Any:
    body: Any = 1
    for _ in range(depth):
        body = [body]
    return body


@pytest.mark.parametrize(
    "body",
    [
        object(),
        {1: "x"},
        float("nan"),
        float("inf"),
        {"time": float("inf")},
        {"x": 10**400},
        [2**64],
        [{"x": {1, 2}}],
        b"bytes",
        _nested(70),
        _nested(100_000),
    ],
)
def test_what_is_not_json_is_refused(bus: Bus, body: Any) -> None:
    with pytest.raises(BusError):
        bus.publish("lumen.a", body)


def test_a_key_of_more_than_255_bytes_is_refused(bus: Bus) -> None:
    with pytest.raises(BusError, match="255"):
        bus.publish("lumen." + "é" * 130, 1)


def test_reply_to_and_correlation_id_are_carried(bus: Bus) -> None:
    seen = Collector()
    bus.subscribe("avatar.NAO.command", seen)
    bus.publish("avatar.NAO.command", {"method": "rest"}, reply_to="lumen.me", correlation_id="42")
    bus.publish("avatar.NAO.command", {"method": "rest"})
    seen.wait(2)
    assert seen.messages[0][:4] == ("avatar.NAO.command", {"method": "rest"}, "lumen.me", "42")
    assert (seen.messages[1].reply_to, seen.messages[1].correlation_id) == ("", "")


def test_a_reply_comes_to_who_asked(bus: Bus) -> None:
    answers = Collector()
    bus.subscribe("lumen.me", answers)
    bus.subscribe("avatar.NAO.command", lambda message: bus.reply(message, "command finished"))
    bus.publish("avatar.NAO.command", {}, reply_to="lumen.me", correlation_id="42")
    bus.publish("avatar.NAO.command", {})
    bus.publish("avatar.NAO.command", {}, reply_to="lumen.me", correlation_id="43")
    assert answers.wait(2) == ["command finished"] * 2
    assert [m.correlation_id for m in answers.messages] == ["42", "43"]


def test_close_delivers_what_was_published(bus: Bus) -> None:
    seen = Collector()
    bus.subscribe("lumen.#", seen)
    for i in range(1000):
        bus.publish("lumen.a", i)
    bus.close()
    assert seen.bodies == list(range(1000))


def test_close_may_be_repeated_and_nothing_is_published_after_it(bus: Bus) -> None:
    seen = Collector()
    bus.subscribe("lumen.a", seen)
    bus.close()
    bus.close()
    with pytest.raises(BusError, match="closed"):
        bus.publish("lumen.a", 1)
    with pytest.raises(BusError, match="closed"):
        bus.subscribe("lumen.a", seen)
    assert not seen.messages


def test_a_handler_may_close_the_bus(bus: Bus) -> None:
    closed = threading.Event()

    def handler(message: Message) -> None:
        bus.close()
        closed.set()

    bus.subscribe("lumen.a", handler)
    bus.publish("lumen.a", 1)
    assert closed.wait(HANG)


def test_two_handles_on_one_bus_hear_each_other(another: Connect) -> None:
    one, other = another(), another()
    seen = Collector()
    one.subscribe("lumen.shared", seen)
    other.publish("lumen.shared", "hello")
    other.close()
    one.publish("lumen.shared", "still here")
    assert seen.wait(2) == ["hello", "still here"]
    one.close()


def test_who_sends_what_a_handler_refuses_gets_the_reason(bus: Bus) -> None:
    answers, others = Collector(), Collector()

    def refuse(message: Message) -> None:
        raise Refused("there is no such dance")

    bus.subscribe("lumen.me", answers)
    bus.subscribe("avatar.NAO.command", refuse)
    bus.subscribe("avatar.NAO.command", others)
    bus.publish("avatar.NAO.command", "waltz", reply_to="lumen.me", correlation_id="42")
    bus.publish("avatar.NAO.command", "waltz")
    assert answers.wait(1) == ["message refused: there is no such dance"]
    assert answers.messages[0].correlation_id == "42"
    assert others.wait(2) == ["waltz", "waltz"]


@pytest.mark.parametrize("carried", Carried)
def test_however_a_route_is_carried_its_messages_arrive_in_order(another: Connect, carried: Carried) -> None:
    key = f"lumen.carried.{carried}"
    routes = {key: Route(key, key, Direction.IN, carried=carried, must_arrive=carried is not Carried.TELEMETRY)}
    bus, seen = another(), Collector()
    bus.prepare(routes)
    bus.carry(routes)
    undo = bus.subscribe(key, seen)
    for i in range(200):
        bus.publish(key, i)
    assert seen.wait(200) == list(range(200))
    undo()
    bus.close()


def test_every_message_has_an_id_a_sender_and_a_time(bus: Bus) -> None:
    seen = Collector()
    bus.subscribe("lumen.a", seen)
    before = int(time.time())
    for i in range(100):
        bus.publish("lumen.a", i)
    bus.publish("lumen.a", 100, origin=MessageOrigin("mine", "ears", 12345.0, "d3"))
    seen.wait(101)
    *own, last = seen.messages
    assert len({message.id for message in own}) == 100
    assert {message.cause for message in own} == {""}
    assert len({message.sender for message in own}) == 1
    assert all(before <= message.time <= time.time() for message in own)
    assert last[4:] == ("mine", "ears", 12345.0, "d3")


def test_an_answer_has_an_id_too(bus: Bus) -> None:
    seen = Collector()
    bus.subscribe("lumen.me", seen)
    bus.subscribe("lumen.ask", lambda message: bus.reply(message, "yes"))
    bus.publish("lumen.ask", 1, reply_to="lumen.me")
    seen.wait(1)
    assert seen.messages[0].id
