"""Messages travel as their routes declare, with a real broker."""

import threading
import time
from collections.abc import Callable, Iterator
from types import SimpleNamespace
from typing import Any

import pika
import pytest

from lumen.bus import Bus, BusError, Message, Refused, connect
from lumen.features.rabbitmq import dispatcher
from lumen.features.rabbitmq.consumer import PREFETCH
from lumen.features.rabbitmq.polled import PolledConnection
from lumen.language.routes import Carried, Direction, Route
from tests.rabbitmq import RabbitMQ
from tests.relay import Relay
from tests.waiting import HANG, Collector, until

pytestmark = pytest.mark.usefixtures("patient_bus")

Open = Callable[..., Bus]


@pytest.fixture
def opened(broker: RabbitMQ) -> Iterator[Open]:
    """Return a function that makes buses with these routes; after the test they are closed, their queues deleted."""
    handles: list[Bus] = []

    def make(*routes: Route, url: str = broker.url) -> Bus:
        bus = connect(url)
        bus.carry({route.key: route for route in routes})
        handles.append(bus)
        return bus

    yield make
    for bus in handles:
        bus.close()


@pytest.fixture
def stranger(broker: RabbitMQ) -> Iterator[Any]:
    connection = pika.BlockingConnection(pika.URLParameters(broker.url))
    channel = connection.channel()
    for name in ("lumen.dead", "lumen.nowhere"):
        channel.exchange_declare(name, "fanout", durable=True)
    yield channel
    connection.close()


def route(key: str, carried: Carried, direction: Direction = Direction.IN, **options: Any) -> Route:
    options.setdefault("must_arrive", carried is not Carried.TELEMETRY)
    options.setdefault("ttl", None if carried is Carried.TELEMETRY else HANG)
    return Route(key, key, direction, carried=carried, **options)


def read(channel: Any, queue: str, key: str = "") -> tuple[Any, Any, bytes]:
    """Wait for the next message of a queue, only on that key if given, and return it.

    The exchanges of copies also receive what the queues of earlier tests put aside late.
    """
    got: list[Any] = []

    def there() -> bool:
        got[:] = channel.basic_get(queue, auto_ack=True)
        return bool(got[0]) and key in ("", got[0].routing_key)

    until(there)
    return got[0], got[1], got[2]


def copies(channel: Any, exchange: str) -> str:
    """Declare a queue for the messages that a fanout exchange receives from now on; return its name."""
    queue = str(channel.queue_declare("", exclusive=True).method.queue)
    channel.queue_bind(queue, exchange)
    return queue


def test_of_telemetry_the_newest_wins_where_a_handler_is_slow(opened: Open) -> None:
    way = route("lumen.newest", Carried.TELEMETRY, keep=1)
    bus, other, seen = opened(way), opened(), Collector()
    busy, go = threading.Event(), threading.Event()

    def slow(message: Message) -> None:
        seen(message)
        busy.set()
        assert go.wait(HANG)

    bus.subscribe("lumen.newest", slow)
    other.publish("lumen.newest", -1)
    assert busy.wait(HANG)
    for i in range(500):
        other.publish("lumen.newest", i)
    other.close()
    (subscription,) = [s for s in bus._transport.consumer.subscriptions() if s.handler is slow]  # type: ignore[attr-defined]
    until(lambda: subscription.received >= PREFETCH)
    go.set()
    until(lambda: seen.bodies[-1] == 499)
    assert len(seen.bodies) <= 10


def test_old_telemetry_is_not_handed_on(opened: Open, monkeypatch: pytest.MonkeyPatch) -> None:
    bus, seen = opened(route("lumen.old", Carried.TELEMETRY, ttl=HANG)), Collector()
    bus.subscribe("lumen.old", seen)
    (subscription,) = [s for s in bus._transport.consumer.subscriptions() if s.handler is seen]  # type: ignore[attr-defined]

    def late() -> float:
        """Return the time, for the three messages after the first a time at which they are too old [s]."""
        return time.monotonic() + (2 * HANG if 2 <= subscription.handled <= 4 else 0.0)

    monkeypatch.setattr(dispatcher, "time", SimpleNamespace(monotonic=late))
    for body in ("first", 0, 1, 2, "new"):
        bus.publish("lumen.old", body)
    assert seen.wait(2) == ["first", "new"]


def test_a_command_waits_for_a_reader_that_is_away_but_not_for_long(opened: Open, stranger: Any) -> None:
    short, long = route("avatar.A.command", Carried.COMMAND, ttl=0.5), route("avatar.A.stop", Carried.COMMAND, ttl=HANG)
    bus, seen, dead = opened(short, long), Collector(), copies(stranger, "lumen.dead")
    sender = opened(route(short.key, Carried.COMMAND), long)  # else it drops what it sends too late itself
    for way in (short, long):
        bus.subscribe(way.key, Collector())
    bus.close()
    sender.publish(short.key, "too early")
    sender.publish(long.key, "in time")
    assert read(stranger, dead, short.key)[2] == b'"too early"'
    bus = opened(short, long)
    for way in (short, long):
        bus.subscribe(way.key, seen)
    assert seen.wait(1) == ["in time"]


def test_a_command_is_never_done_twice(opened: Open, stranger: Any) -> None:
    way = route("avatar.B.command", Carried.COMMAND)
    bus, seen = opened(way), Collector()
    bus.subscribe(way.key, seen)
    for id in ("1", "2", "1", None, None):
        stranger.basic_publish("amq.topic", way.key, b"0", pika.BasicProperties(message_id=id))
    stranger.basic_publish("amq.topic", way.key, b"1")
    until(lambda: seen.bodies[-1:] == [1])
    assert seen.bodies == [0, 0, 0, 0, 1]


def test_an_id_is_that_of_its_sender_and_who_uses_it_again_is_answered(opened: Open, stranger: Any) -> None:
    way = route("avatar.B.command", Carried.COMMAND)
    bus, seen = opened(way), Collector()
    bus.subscribe(way.key, seen)
    mine = stranger.queue_declare("", exclusive=True).method.queue
    for sender, body in (("desk", b"1"), ("door", b"2"), ("desk", b"3")):
        said = pika.BasicProperties(message_id="1", app_id=sender, reply_to=mine, correlation_id=sender)
        stranger.basic_publish("amq.topic", way.key, body, said)
    _, properties, answer = read(stranger, mine)
    reason = "'desk' has sent the id '1' before: give each message its own id"
    assert (properties.correlation_id, answer.decode()) == ("desk", f"message refused: {reason}")
    assert seen.bodies == [1, 2]
    assert bus.dropped == {way.key: 1}


def test_what_failed_in_a_handler_is_put_aside_with_the_reason(opened: Open, stranger: Any) -> None:
    way = route("avatar.C.command", Carried.COMMAND)
    bus, dead = opened(way), copies(stranger, "lumen.dead")

    def fail(message: Message) -> None:
        raise KeyError("arm")

    bus.subscribe(way.key, fail)
    stranger.basic_publish("amq.topic", way.key, b'{"method": "wave"}')
    _, properties, body = read(stranger, dead, way.key)
    assert body == b'{"method": "wave"}'
    assert properties.headers == {"key": way.key, "reason": "its handler failed: KeyError('arm')"}


@pytest.mark.parametrize(
    ("name", "body", "reason"),
    [
        ("cut", b"{", "it is not JSON"),
        ("odd", b"\xff", "it is not UTF-8"),
        ("deep", b"[" * 10_000 + b"]" * 10_000, "deeper than 64"),
        ("refused", b'"no"', "unusable"),
    ],
    ids=["cut", "odd", "deep", "refused"],
)
def test_a_module_of_2015_gets_an_answer_to_what_nobody_can_use(
    opened: Open, stranger: Any, name: str, body: bytes, reason: str
) -> None:
    key = f"avatar.{name}.command"
    bus, dead = opened(), copies(stranger, "lumen.dead")

    def refuse(message: Message) -> None:
        raise Refused(f"it is {message.body}: unusable")

    bus.subscribe(key, refuse)
    mine = stranger.queue_declare("", exclusive=True).method.queue
    stranger.basic_publish("amq.topic", key, body, pika.BasicProperties(reply_to=mine, correlation_id="7"))
    _, properties, answer = read(stranger, mine)
    assert answer.decode().startswith("message refused: ")
    assert reason in answer.decode()
    assert (properties.correlation_id, properties.content_type) == ("7", "text/plain")
    assert read(stranger, dead, key)[2] == body


def test_a_stop_waits_behind_nothing(opened: Open) -> None:
    slow, stop = route("avatar.E.command", Carried.COMMAND), route("avatar.E.stop", Carried.STOP)
    bus, sender, seen = opened(slow, stop), opened(slow, stop), Collector()
    busy, go = threading.Event(), threading.Event()

    def work(message: Message) -> None:
        busy.set()
        assert go.wait(HANG)

    bus.subscribe(slow.key, work)
    bus.subscribe(stop.key, seen)
    sender.publish(slow.key, "dance")
    assert busy.wait(HANG)
    for _ in range(200):
        sender.publish(slow.key, "x" * 100_000)
    sender.publish(stop.key, "stop")
    assert seen.wait(1) == ["stop"]
    go.set()


def test_a_journal_that_goes_out_is_kept_for_who_comes_later(opened: Open, stranger: Any) -> None:
    way = route("lumen.F.journal", Carried.JOURNAL, Direction.OUT)
    bus = opened(way)
    for i in range(50):
        bus.publish(way.key, i)
    bus.close()
    stranger.basic_qos(prefetch_count=100)
    read: list[bytes] = []
    for method, _, body in stranger.consume("lumen.journal.lumen.F.journal", arguments={"x-stream-offset": "first"}):
        stranger.basic_ack(method.delivery_tag)
        read.append(body)
        if len(read) == 50:
            break
    stranger.cancel()
    assert read == [str(i).encode() for i in range(50)]


def test_a_journal_that_comes_in_loses_nothing_while_its_reader_is_away(opened: Open) -> None:
    way = route("lumen.G.journal", Carried.JOURNAL)
    bus, sender, first, later = opened(way), opened(way), Collector(), Collector()
    bus.subscribe(way.key, first)
    sender.publish(way.key, 0)
    first.wait(1)
    bus.close()
    for i in range(1, 200):
        sender.publish(way.key, i)
    again = opened(way)
    again.subscribe(way.key, later)
    assert first.bodies + later.wait(199) == list(range(200))


def test_what_nobody_waits_for_is_told_once_with_the_nearest_key(
    opened: Open, stranger: Any, caplog: pytest.LogCaptureFixture
) -> None:
    out = Direction.OUT
    lost = route("lumen.H.speech.recogniton", Carried.COMMAND, out)
    bus, nowhere = (
        opened(lost, route("lumen.H.speech.recognition", Carried.TELEMETRY)),
        copies(stranger, "lumen.nowhere"),
    )
    bus.publish(lost.key, "hello")
    bus.publish(lost.key, "hello?")
    for body in (b'"hello"', b'"hello?"'):
        _, properties, got = read(stranger, nowhere, lost.key)
        assert got == body
        assert properties.headers == {"reason": f"no process receives `{lost.key}`"}
    told = [r.getMessage() for r in caplog.records if "no process receives" in r.getMessage()]
    assert told == [f"no process receives messages on `{lost.key}`: did you mean `lumen.H.speech.recognition`?"]


def test_a_time_to_live_that_changes_makes_the_queue_anew(opened: Open, caplog: pytest.LogCaptureFixture) -> None:
    seen = Collector()
    for ttl in (HANG, 2 * HANG):
        way = route("avatar.I.command", Carried.COMMAND, ttl=ttl)
        bus = opened(way)
        bus.subscribe(way.key, seen)
        bus.publish(way.key, ttl)
        until(lambda ttl=ttl: seen.bodies[-1:] == [ttl])  # type: ignore[misc]
        bus.close()
    assert not caplog.records


def test_a_queue_that_is_in_use_otherwise_is_used_as_it_is(opened: Open) -> None:
    one, other = (route("avatar.J.command", Carried.COMMAND, ttl=ttl) for ttl in (HANG, 2 * HANG))
    first, second, seen = opened(one), opened(other), Collector()
    first.subscribe(one.key, Collector())
    second.subscribe(one.key, seen)
    first.close()
    second.publish(one.key, "to the one who is left")
    assert seen.wait(1) == ["to the one who is left"]


def test_a_route_that_is_given_up_leaves_no_queue(opened: Open, stranger: Any) -> None:
    way = route("avatar.K.command", Carried.COMMAND)
    bus = opened(way)
    undo = bus.subscribe(way.key, Collector())
    stranger.queue_declare("lumen.queue.avatar.K.command", passive=True)
    undo()
    bus.close()
    with pytest.raises(pika.exceptions.ChannelClosedByBroker, match="NOT_FOUND"):
        stranger.queue_declare("lumen.queue.avatar.K.command", passive=True)


@pytest.mark.parametrize("carried", list(Carried))
def test_keys_of_an_exhibition_s_own_are_carried_as_lumen_s(opened: Open, carried: Carried) -> None:
    way = route(f"museum.lamp.{carried}", carried)
    bus, sender, seen = opened(way), opened(way), Collector()
    undo = bus.subscribe(way.key, seen)
    sender.publish(way.key, {"level": 0.5})
    assert seen.wait(1) == [{"level": 0.5}]
    undo()


@pytest.mark.parametrize("carried", [Carried.COMMAND, Carried.JOURNAL])
def test_who_leaves_takes_nothing_from_who_stays(opened: Open, carried: Carried) -> None:
    way = route(f"avatar.O.{carried}", carried)
    first, second, sender, seen = opened(way), opened(way), opened(way), Collector()
    undo = first.subscribe(way.key, Collector())
    second.subscribe(way.key, seen)
    undo()
    first.close()
    sender.publish(way.key, "to who stays")
    assert seen.wait(1) == ["to who stays"]


@pytest.mark.parametrize("carried", [Carried.COMMAND, Carried.JOURNAL])
def test_who_leaves_while_another_comes_takes_nothing_from_them(
    opened: Open, carried: Carried, monkeypatch: pytest.MonkeyPatch
) -> None:
    way = route(f"avatar.P.{carried}", carried)
    first, second, sender, seen = opened(way), opened(way), opened(way), Collector()
    undo = first.subscribe(way.key, Collector())
    consume = PolledConnection.consume

    def between(connection: PolledConnection, *told: Any) -> str:
        """Close the first reader after the second one declared the queue and before it consumes."""
        monkeypatch.undo()
        undo()
        first.close()
        return consume(connection, *told)

    monkeypatch.setattr(PolledConnection, "consume", between)
    second.subscribe(way.key, seen)
    sender.publish(way.key, "to who comes")
    assert seen.wait(1) == ["to who comes"]


def test_what_was_prepared_is_subscribed_to_without_waiting_for_the_network(
    broker: RabbitMQ, opened: Open, caplog: pytest.LogCaptureFixture
) -> None:
    relay, seen = Relay(broker.port), Collector()
    url = f"amqp://guest:guest@{broker.place(relay.port)}"
    ways = [route(f"lumen.L.{i}", carried, ttl=HANG) for i, carried in enumerate((Carried.TELEMETRY, Carried.COMMAND))]
    bus, sender = opened(url=url), opened()
    bus.prepare({way.key: way for way in ways})
    relay.cut()
    bus.carry({way.key: way for way in ways})
    for way in ways:
        bus.subscribe(way.key, seen)
    assert "does not confirm the subscription" not in caplog.text, "nothing comes through a relay that is cut"
    for way in ways:
        sender.publish(way.key, way.key)
    sender.close()
    relay.mend()
    assert sorted(seen.wait(2)) == ["lumen.L.0", "lumen.L.1"]
    bus.close()
    relay.close()


def test_preparing_says_what_the_broker_refuses(broker: RabbitMQ) -> None:
    bus = connect(broker.url_of("visual"))
    with pytest.raises(BusError, match=r"refuses the subscription to `lumen\.secret`: ACCESS_REFUSED"):
        bus.prepare({"lumen.secret": route("lumen.secret", Carried.TELEMETRY)})
    bus.prepare({"avatar.M": route("avatar.M", Carried.TELEMETRY)})
    bus.prepare({})
    bus.close()


def test_a_route_that_is_carried_otherwise_goes_on(opened: Open) -> None:
    as_telemetry, as_command = (route("avatar.N.command", c) for c in (Carried.TELEMETRY, Carried.COMMAND))
    bus, seen = opened(as_telemetry), Collector()
    bus.subscribe("avatar.N.command", seen)
    for i, way in enumerate((as_command, as_telemetry, as_command)):
        bus.carry({way.key: way})
        bus.publish(way.key, i)
        until(lambda i=i: i in seen.bodies)  # type: ignore[misc]
    (subscription,) = [s for s in bus._transport.consumer.subscriptions() if s.handler is seen]  # type: ignore[attr-defined]
    until(lambda: subscription.queue == "lumen.queue.avatar.N.command")
