"""Messages found in the socket after a stall count as old as they can be; all others count as new."""

import pytest

from lumen.features.rabbitmq.polled import STALL_TIME, TurnClock


class Time:
    now = 100.0

    def __call__(self) -> float:
        return self.now


@pytest.fixture
def time() -> Time:
    return Time()


@pytest.fixture
def clock(time: Time) -> TurnClock:
    return TurnClock(time)


def test_what_comes_within_a_turn_is_new(time: Time, clock: TurnClock) -> None:
    for _ in range(5):
        clock.begin(1.0)
        time.now += 1.0
        assert clock.arrival() == time.now


def test_who_stood_still_in_a_turn_and_reads_in_it(time: Time, clock: TurnClock) -> None:
    clock.begin(1.0)
    time.now += 8.0
    assert clock.arrival() == 100.0


def test_who_stood_still_in_a_turn_and_reads_in_the_next(time: Time, clock: TurnClock) -> None:
    clock.begin(1.0)
    time.now += 8.0
    clock.begin(1.0)
    time.now += 0.1
    assert clock.arrival() == 100.0
    clock.begin(1.0)
    assert clock.arrival() == time.now


def test_many_short_turns_are_no_standing_still(time: Time, clock: TurnClock) -> None:
    """Such turns follow each other while the broker needs a second to declare a queue."""
    for _ in range(10):
        clock.begin(0.5)
        time.now += 0.3
    assert clock.arrival() == time.now


def test_what_is_done_between_two_turns_counts(time: Time, clock: TurnClock) -> None:
    clock.begin(0.1)
    time.now += 0.1 + STALL_TIME + 0.1
    clock.begin(1.0)
    assert clock.arrival() == 100.0
