"""Abilities that only some buses have are found by protocol, however often the bus is wrapped."""

from collections.abc import Callable, Mapping
from typing import Any

import pytest

import lumen
from lumen.bus import Bus, connect
from lumen.bus.validated import ValidatedBus
from lumen.language.routes import Route
from lumen.ports import (
    BlockableBus,
    CountsDrops,
    EndsWithExhibition,
    KnowsListeners,
    Message,
    MessageHandler,
    Outgoing,
    ReturningBus,
    SignsMessages,
    UsesBroker,
)
from tests import ROOT

PROJECT = lumen.load(ROOT)
ABILITIES = (
    BlockableBus,
    CountsDrops,
    EndsWithExhibition,
    KnowsListeners,
    ReturningBus,
    SignsMessages,
    UsesBroker,
)


class PlainBus(Bus):
    """A bus of another package, with the required methods only."""

    def __init__(self) -> None:
        self.sent: list[Outgoing] = []

    def carry(self, routes: Mapping[str, Route]) -> None: ...

    def prepare(self, routes: Mapping[str, Route]) -> None: ...

    def subscribe(self, pattern: str, handler: MessageHandler) -> Callable[[], None]:
        return lambda: None

    def send(self, message: Outgoing) -> None:
        self.sent.append(message)

    def reply(self, message: Message, body: Any) -> None: ...

    def close(self) -> None: ...


class GiftedBus(PlainBus):
    """A bus with every ability."""

    blocked, sender, host, away, gone = "memory", "me", "hall", True, None
    dropped: Mapping[str, int] = {"lumen.x": 2}

    def heard(self, key: str) -> bool:
        return False

    def returns(self, handler: Callable[[str], None]) -> None: ...


def wrapped(bus: Bus) -> Bus:
    return ValidatedBus(ValidatedBus(bus, PROJECT), PROJECT)


@pytest.mark.parametrize("ability", ABILITIES)
def test_a_wrapped_bus_has_the_abilities_of_the_bus_within(ability: type) -> None:
    bus = GiftedBus()
    assert isinstance(found := wrapped(bus).ability(ability), ability)
    assert found is bus or ability is KnowsListeners  # which the wrapper asks about aliases, too


@pytest.mark.parametrize("ability", [ability for ability in ABILITIES if ability is not KnowsListeners])
def test_a_wrapped_bus_has_no_other_ability(ability: type) -> None:
    assert wrapped(PlainBus()).ability(ability) is None


def test_who_listens_is_passed_inward_and_unknown_counts_as_somebody() -> None:
    listeners = [wrapped(bus).ability(KnowsListeners) for bus in (GiftedBus(), PlainBus())]
    assert [each and each.heard("lumen.x") for each in listeners] == [False, True]


@pytest.mark.parametrize("bus", [connect("memory://", sender="me")])
def test_the_embedded_bus_signs_counts_and_knows_its_listeners(bus: Bus) -> None:
    has = [ability for ability in ABILITIES if wrapped(bus).ability(ability)]
    assert has == [CountsDrops, KnowsListeners, SignsMessages]


def test_publishing_on_a_bus_of_ones_own_arrives_as_one_message() -> None:
    bus = PlainBus()
    wrapped(bus).publish("lumen.x", {"a": 1}, reply_to="lumen.me", correlation_id="7", ttl=2.0)
    (sent,) = bus.sent
    assert sent[:5] == ("lumen.x", {"a": 1}, "lumen.me", "7", 2.0)
    assert sent.id
