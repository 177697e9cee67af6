"""Pauses between attempts."""

from lumen.upkeep.ratelimit import Backoff, pause_after


def test_each_pause_is_twice_as_long_up_to_the_longest() -> None:
    backoff = Backoff(0.5, 3.0)
    assert [backoff.next() for _ in range(5)] == [0.5, 1.0, 2.0, 3.0, 3.0]


def test_a_success_begins_with_the_first_pause_again() -> None:
    backoff = Backoff(1.0)
    assert [backoff.next(), backoff.next()] == [1.0, 2.0]
    backoff.reset()
    assert backoff.next() == 1.0


def test_no_failure_needs_no_pause_and_many_are_no_error() -> None:
    assert pause_after(0, 1.0) == pause_after(-3, 1.0) == 0.0
    assert pause_after(1_000_000, 1.0, 60.0) == 60.0
