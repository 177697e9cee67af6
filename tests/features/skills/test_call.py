"""A call, as the code of a skill sees it: it waits and can be cancelled. These tests need no process."""

import threading
from typing import Any

import pytest

from lumen.skills import CurrentCall
from tests.waiting import until


@pytest.mark.parametrize("duration", ["soon", "-2s", -1, float("nan"), float("inf")])
def test_a_wait_for_what_is_no_duration_is_refused_and_asks_for_nothing(duration: float | str) -> None:
    sent: list[dict[str, Any]] = []
    with pytest.raises(ValueError, match="is not a duration: write a number of seconds"):
        CurrentCall("act", {}, sent.append).wait(duration)
    assert sent == []


def test_a_call_waits_by_the_robot_s_clock_and_not_once_it_is_cancelled() -> None:
    sent: list[dict[str, Any]] = []
    waited: list[bool] = []
    call = CurrentCall("act", {}, sent.append)
    thread = threading.Thread(target=lambda: waited.append(call.wait("500ms")))
    thread.start()
    until(lambda: sent == [{"wait": 0.5}])
    assert waited == []
    call._go()
    thread.join()
    assert waited == [True]
    call._cancel()
    assert call.cancelled
    assert call.wait("2min") is False
    assert sent == [{"wait": 0.5}]
