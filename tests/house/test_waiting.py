"""A wait that fails reports its condition, and the last value that it saw."""

import threading

import pytest

from lumen.bus import connect
from tests.waiting import Collector, finished, source_of, until

SHORT = 0.01
"""The time limit of waits that are to fail [s]."""


def test_a_condition_that_holds_is_enough() -> None:
    looks = iter([False, [], 0, "yes"])
    until(lambda: next(looks), every=0.0)
    assert list(looks) == []


def test_a_failure_reads_as_the_condition_and_shows_its_variables() -> None:
    effects, sent = [1, 2], 3
    with pytest.raises(AssertionError) as failure:
        until(lambda: len(effects) > 2 * sent, SHORT)
    words = str(failure.value).partition("\n")[0]
    assert words == "waited 0.01 s for: len(effects) > 2 * sent; last: False, effects = [1, 2], sent = 3"
    with pytest.raises(AssertionError, match=r"waited 0\.01 s for: the effects"):
        until(lambda: False, SHORT, what="the effects")


def test_a_condition_over_lines_reads_as_one() -> None:
    done = {"a": False}
    condition = lambda: [  # noqa: E731
        name for name, state in done.items() if state or name == "ö"
    ]
    assert source_of(condition) == '[ # noqa: E731 name for name, state in done.items() if state or name == "ö" ]'


def test_a_function_reads_as_its_name_and_first_line() -> None:
    def settled() -> bool:
        """Whether nothing moves.

        Never here.
        """
        return False

    assert source_of(settled).endswith("settled(): Whether nothing moves.")
    assert source_of([].clear).startswith("<built-in method clear of list")
    with pytest.raises(AssertionError, match=r"waited 0\.01 s for: .*settled"):
        until(settled, SHORT)
    with pytest.raises(AssertionError, match="built-in method clear"):
        until([].clear, SHORT)  # type: ignore[func-returns-value]


def test_a_collector_says_what_came() -> None:
    seen, bus = Collector(), connect("memory://")
    bus.subscribe("lumen.a", seen)
    bus.publish("lumen.a", "hello")
    assert seen.wait(1) == ["hello"]
    with pytest.raises(AssertionError, match=r"waited 0\.01 s for 2 messages; received <1 messages, .*'hello'"):
        seen.wait(2, SHORT)
    bus.close()


def test_a_thread_that_ends_is_joined() -> None:
    thread = threading.Thread(target=lambda: None)
    thread.start()
    finished(thread)
    assert not thread.is_alive()
