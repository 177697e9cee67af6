"""A flood is reduced to its route's rate before a body is read; the newest messages arrive, the others are counted."""

import logging
import time
from collections.abc import Callable, Iterator
from itertools import pairwise
from typing import Any

import pika
import pytest

from lumen.bus import Bus, connect
from lumen.features.rabbitmq import intake as taking
from lumen.features.rabbitmq.intake import SPENT_BATCH, Intake
from lumen.features.rabbitmq.properties import MessageProperties
from lumen.features.rabbitmq.subscriptions import Delivery, Subscription
from lumen.language.routes import MAX_RATE, USUAL_RATE, Carried, Direction, Route
from lumen.upkeep.ratelimit import BURST, RateLimiter
from tests.rabbitmq import RabbitMQ
from tests.waiting import Collector, until


class Line:
    """An intake with a clock of the test, and the messages that it let through."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch, route: Route | None) -> None:
        self.now, self.number = 0.0, 0
        self.passed: list[Delivery] = []
        self.refused: list[str] = []
        self.due: list[tuple[float, Callable[[], None]]] = []
        monkeypatch.setattr(taking, "RateLimiter", lambda: RateLimiter(lambda: self.now))
        self.subscription = Subscription("lumen.a", None, route)
        self.intake = Intake(self.passed.append, lambda d, why: self.refused.append(why), self.later)

    def later(self, seconds: float, work: Callable[[], None]) -> None:
        self.due.append((self.now + seconds, work))

    def come(self, count: int, key: str = "lumen.a") -> None:
        for _ in range(count):
            self.number += 1
            self.intake.take(Delivery(self.subscription, key, b"", MessageProperties(), self.number, 1))

    def pass_time(self, seconds: float) -> None:
        self.now += seconds
        due, self.due = self.due, []
        for at, work in due:
            work() if at <= self.now + 1e-9 else self.due.append((at, work))

    @property
    def taken(self) -> list[int]:
        return [delivery.number for delivery in self.passed if not delivery.spent]


def route(carried: Carried = Carried.TELEMETRY, **options: Any) -> Route:
    return Route("a", "lumen.a", Direction.IN, carried=carried, must_arrive=carried is not Carried.TELEMETRY, **options)


def test_a_route_says_how_many_are_taken() -> None:
    assert route().rate == route(Carried.COMMAND).rate == USUAL_RATE
    assert Route("a", "lumen.a", Direction.OUT).rate == MAX_RATE
    assert route(most=0.5).rate == 0.5
    assert route(Carried.JOURNAL).rate == 0.0


def test_of_telemetry_the_newest_waits_and_the_rest_is_counted(monkeypatch: pytest.MonkeyPatch) -> None:
    line = Line(monkeypatch, route(most=2.0))
    line.come(15)
    assert line.taken == list(range(1, 11))
    line.pass_time(0.5)
    assert line.taken[-1] == 15
    line.come(1)
    assert line.taken[-1] == 15
    line.pass_time(0.5)
    assert line.taken[-1] == 16
    assert line.intake.drops.counts == {"lumen.a": 4}
    line.pass_time(5.0)
    assert line.taken[-2:] == [15, 16], "nothing comes twice"


def test_what_waits_gives_way_to_a_newer_one_for_which_there_is_room(monkeypatch: pytest.MonkeyPatch) -> None:
    line = Line(monkeypatch, route(most=2.0))
    line.come(11)
    line.now += 0.5
    line.come(1)
    line.pass_time(0.0)
    assert line.taken[-1] == 12
    assert 11 not in line.taken
    assert line.intake.drops.counts == {"lumen.a": 1}


def test_keys_have_a_rate_each(monkeypatch: pytest.MonkeyPatch) -> None:
    line = Line(monkeypatch, route())
    line.come(int(9 * USUAL_RATE))
    line.come(5, "lumen.b")
    assert len(line.taken) == BURST * USUAL_RATE + 5


def test_of_keys_that_no_route_has_all_is_taken(monkeypatch: pytest.MonkeyPatch) -> None:
    line = Line(monkeypatch, None)
    line.come(9_000)
    assert len(line.taken) == 9_000


def test_commands_that_are_too_many_are_refused_some_with_an_answer(monkeypatch: pytest.MonkeyPatch) -> None:
    line = Line(monkeypatch, route(Carried.COMMAND))
    line.come(2_000)
    assert line.taken == list(range(1, 251))
    assert line.refused == ["more than 50 messages a second arrive"] * 50
    assert line.intake.drops.counts == {"lumen.a": 1_750}
    line.pass_time(1.0)
    line.come(1)
    assert line.taken[-1] == 2_001


def test_the_broker_hears_of_what_was_dropped_before_it_stops_sending(monkeypatch: pytest.MonkeyPatch) -> None:
    line = Line(monkeypatch, route(Carried.COMMAND))
    line.come(2_000)
    spent = [delivery.number for delivery in line.passed if delivery.spent]
    assert [after - before for before, after in pairwise(spent)] == [SPENT_BATCH] * (len(spent) - 1)
    assert line.number - spent[-1] < SPENT_BATCH


@pytest.fixture
def bus(broker: RabbitMQ) -> Iterator[Bus]:
    bus = connect(broker.url)
    bus.carry({"lumen.flood": Route("flood", "lumen.flood", Direction.IN, keep=1), "lumen.calm": route()})
    yield bus
    bus.close()


def test_a_flood_on_the_broker_arrives_as_its_newest_and_everything_else_goes_on(
    bus: Any, broker: RabbitMQ, caplog: pytest.LogCaptureFixture
) -> None:
    seen, calm = Collector(), Collector()
    bus.subscribe("lumen.flood", seen)
    bus.subscribe("lumen.calm", calm)
    connection = pika.BlockingConnection(pika.URLParameters(broker.url))
    channel = connection.channel()
    sent = 0

    def flooded() -> bool:
        """Send a thousand more; return whether we dropped some, beside those that the broker replaced by newer ones."""
        nonlocal sent
        for _ in range(1_000):
            sent += 1
            channel.basic_publish("amq.topic", "lumen.flood", b"%d" % sent)
        return sent >= 3_000 and bus.dropped["lumen.flood"] > 0

    with caplog.at_level(logging.WARNING):
        began = time.monotonic()
        until(flooded)
        channel.basic_publish("amq.topic", "lumen.calm", b"1")
        until(lambda: seen.bodies[-1:] == [sent])
        assert calm.wait(1) == [1]
        channel.basic_publish("amq.topic", "lumen.flood", b"-1")
        until(lambda: seen.bodies[-1:] == [-1])
    connection.close()
    assert len(seen.bodies) <= USUAL_RATE * (BURST + time.monotonic() - began) + 1
    assert "messages on `lumen.flood` are dropped: more than 50 messages a second arrive" in caplog.text
