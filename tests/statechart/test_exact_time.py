"""Virtual time is exact: timers add up whole nanoseconds, whatever floats would make of them."""

import json

import pytest

from lumen.clock.simulated import SimulatedClock
from lumen.statechart import Interpreter, Machine, Step, VirtualClock

TICKING = Machine.from_dict(
    {
        "context": {"n": 0},
        "initial": "tick",
        "states": {"tick": {"after": {"10ms": {"target": "tick", "actions": [{"assign": {"n": "context.n + 1"}}]}}}},
    }
)


def ticking(clock: VirtualClock | None = None) -> Interpreter:
    it = Interpreter(TICKING, clock)
    it.start()
    return it


@pytest.mark.parametrize("steps", [1, 21, 210])
def test_the_21st_tick_of_10_ms_comes_at_210_ms(steps: int) -> None:
    clock = VirtualClock()
    it = ticking(clock)
    for _ in range(steps):
        clock.advance(0.21 / steps)
    assert it.context == {"n": 21}
    assert it.next_due() == 0.22


@pytest.mark.parametrize("late", [0.0, 0.1 + 0.2, 86_400.0 * 30])
def test_a_million_milliseconds_are_a_thousand_seconds(late: float) -> None:
    machine = Machine.from_dict({"states": {"a": {"after": {"1ms": "a"}}}})
    clock, seen = VirtualClock(late), list[Step]()
    it = Interpreter(machine, clock, observe=seen.append)
    it.start()
    clock.advance(1.0)
    assert len(seen) == 1001
    assert clock.now() == round(late + 1.0, 9)


COUNT = {"assign": {"n": "context.n + 1"}}
SEND = {"send": {"event": "t", "delay": "70ms"}}
WAITING = {"do": [{"wait": "70ms"}], "onDone": {"target": "s", "actions": [COUNT]}}


@pytest.mark.parametrize(
    "state", [{"entry": [SEND], "on": {"t": {"actions": [COUNT, SEND]}}}, WAITING], ids=["send", "wait"]
)
def test_send_and_wait_add_up_too(state: dict[str, object]) -> None:
    clock = VirtualClock()
    it = Interpreter(Machine.from_dict({"context": {"n": 0}, "states": {"s": state}}), clock)
    it.start()
    for _ in range(100):
        clock.advance(0.7)
    assert it.context == {"n": 1000}


@pytest.mark.parametrize("policy", ["deadline", "remaining"])
def test_a_snapshot_keeps_the_nanosecond(policy: str) -> None:
    it = ticking()
    for _ in range(100):
        it = Interpreter.restore(TICKING, json.loads(json.dumps(it.snapshot())), timers=policy)  # type: ignore[arg-type]
        assert isinstance(it.clock, VirtualClock)
        it.clock.advance(0.003)
    it.clock.advance(0.01)  # type: ignore[attr-defined]
    assert it.context == {"n": 31}
    assert it.next_due() == 0.32


def test_the_clock_of_a_simulation_does_not_drift() -> None:
    clock = SimulatedClock(lambda dt: None)
    for _ in range(50 * 3600):
        clock.wait(clock.now() + 0.02)
    assert clock.now() == 3600.0
