"""Thousands of random attacks on running exhibitions: these tick, obey a stop and speak afterwards; nothing grows."""

from random import Random

import pytest

from tests.attack.__main__ import report
from tests.attack.attacks import Attack, Kind, attack
from tests.attack.messages import message
from tests.attack.running import BOUND, SETTLED, Survey, grown, surveyed
from tests.attack.targets import BrokenError, Size
from tests.rabbitmq import RabbitMQ


def test_a_number_says_what_comes() -> None:
    assert [attack(n).kind for n in range(50)] == [attack(n).kind for n in range(50)]
    assert {attack(n).kind for n in range(5_000)} == set(Kind)
    assert message(Random(7), {"a": {"x": 1}}) == message(Random(7), {"a": {"x": 1}})


def test_what_grows_is_told() -> None:
    before, after = Size(50.0, 10, 20), Size(50.0, 10, 21)
    assert grown(Survey("one", sizes=[before] * SETTLED + [after])) == ["one: +1 handles, at most +0"]
    assert BOUND.threads == BOUND.handles == 0


class Fragile:
    """A lane that breaks after attacks 5 and 9."""

    batch = 100

    def __init__(self) -> None:
        self.seen = set[int]()

    def strike(self, attack: Attack) -> str:
        self.seen.add(attack.number)
        return ""

    def check(self) -> None:
        if {5, 9} <= self.seen:
            raise BrokenError("broken")

    def size(self) -> Size:
        return Size(0, 0, 0)

    def close(self) -> None: ...


def test_what_breaks_a_target_is_narrowed_down() -> None:
    found = surveyed("one", list(range(300)), Fragile)
    assert found.count == 300
    assert [(trouble.numbers[0], trouble.text) for trouble in found.troubles] == [(0, "broken")]
    assert 9 in found.troubles[0].numbers
    assert len(found.troubles[0].numbers) < 100


@pytest.mark.slow
def test_a_thousand_attacks_break_nothing(broker: RabbitMQ) -> None:
    assert report(range(1_000), broker.url) == []


@pytest.mark.soak
def test_a_hundred_thousand_attacks_break_nothing(broker: RabbitMQ) -> None:
    assert report(range(100_000, 200_000), broker.url) == []
