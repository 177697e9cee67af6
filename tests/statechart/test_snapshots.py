"""Snapshots on the disk: their time, their timers on another clock, and what is refused of damaged ones."""

import json
from collections.abc import Iterator
from contextlib import suppress
from copy import deepcopy
from typing import Any

import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

from lumen.clock.real import RealClock
from lumen.clock.virtual import VirtualClock
from lumen.errors import LumenError, SnapshotError, UsageError
from lumen.statechart import Event, Interpreter, Machine, initial, serialize, step
from tests.tables import for_each

QUIZ = {"states": {"ask": {"after": {"3s": "end"}}, "end": {"type": "final"}}}
WAITING = {"states": {"a": {"after": {"4s": "b"}}, "b": {"after": {"4s": "c"}}, "c": None}}
INVOKING = {"states": {"a": {"invoke": {"behavior": "quiz", "onDone": "b"}}, "b": None}}
DOING = {"states": {"a": {"do": [{"wait": "3s"}], "onDone": "b"}, "b": None}}
SENDING = {"states": {"a": {"entry": {"send": {"event": "x", "delay": "3s"}}, "on": {"x": "b"}}, "b": None}}
TELLING = {"states": {"a": {"invoke": {"behavior": "teller"}, "on": {"x": "b"}}, "b": None}}
TELLER = {"states": {"t": {"entry": {"send": {"event": "x", "to": "parent", "delay": "3s"}}}}}
MIDDLE = {"states": {"m": {"invoke": {"behavior": "quiz", "onDone": "n"}}, "n": {"type": "final"}}}
DEEP = {"states": {"a": {"invoke": {"behavior": "middle", "onDone": "b"}}, "b": None}}


def machine(data: dict[str, Any]) -> Machine:
    return Machine.from_dict(data, behaviors={"quiz": QUIZ, "middle": MIDDLE, "teller": TELLER})


def saved(data: dict[str, Any], after: float) -> dict[str, Any]:
    """Return the snapshot on the disk after this time [s] without an event."""
    it = Interpreter(machine(data), epoch=7200.0)
    it.start()
    it.clock.advance(after)
    written: dict[str, Any] = json.loads(json.dumps(it.snapshot(), allow_nan=False))
    assert written["at"] == after
    return written


@for_each(("timers", "ends"), [("deadline", 100.0), ("remaining", 102.0), ("restart", 103.0)])
@for_each("data", [INVOKING, DOING, SENDING, TELLING, DEEP], ids=["invoke", "wait", "send", "to", "two levels"])
def test_a_timer_that_was_under_way(data: dict[str, Any], timers: Any, ends: float) -> None:
    again = Interpreter.restore(machine(data), saved(data, 1.0), VirtualClock(100.0), timers)
    assert (again.configuration == frozenset({"b"})) is (ends == 100.0)
    again.clock.wait(ends - 0.01)
    assert (again.configuration == frozenset({"b"})) is (ends == 100.0)
    again.clock.wait(ends)
    assert again.configuration == frozenset({"b"})


def test_time_goes_on_where_the_snapshot_was_taken() -> None:
    again = Interpreter.restore(machine(WAITING), saved(WAITING, 1.5))
    assert (again.clock.now(), again.next_due()) == (1.5, 4.0)
    assert again.snapshot() == saved(WAITING, 1.5)


def test_what_is_past_comes_once_and_now() -> None:
    again = Interpreter.restore(machine(WAITING), saved(WAITING, 1.0), VirtualClock(100.0))
    assert (again.configuration, again.next_due()) == (frozenset({"b"}), 104.0)


def test_a_clock_that_is_behind_keeps_the_deadline() -> None:
    again = Interpreter.restore(machine(WAITING), saved(WAITING, 3.0), VirtualClock())
    assert again.send("nothing").snapshot.at == 0.0
    assert again.next_due() == 4.0


def test_a_real_clock_goes_on_counting() -> None:
    it = Interpreter(machine(WAITING), RealClock(50.0))
    it.start()
    frozen = it.snapshot()
    assert 50.0 <= frozen["at"] <= it.clock.now()
    assert (it.next_due() or 0.0) > 54.0 - 1e-6
    again = Interpreter.restore(machine(WAITING), frozen, RealClock(), "remaining")
    assert 0.0 < (again.next_due() or 0.0) <= 4.0 + again.clock.now()


@pytest.mark.parametrize(("timers", "hour"), [("deadline", 3), ("remaining", 2), ("restart", 2)])
def test_the_time_of_day_goes_on_with_the_clock(timers: Any, hour: int) -> None:
    data = {"states": {"a": {"on": {"go": {"guard": f"hour() == {hour}", "target": "b"}}}, "b": None}}
    again = Interpreter.restore(machine(data), saved(data, 1.0), VirtualClock(3601.0), timers)
    again.send("go")
    assert again.configuration == frozenset({"b"})


@for_each("bad", [float("nan"), {"x": [float("inf")]}, {1, 2}, {3: 4}, object(), 10**400])
def test_what_json_can_not_hold_is_refused_at_the_door(bad: Any) -> None:
    keeping = Machine.from_dict(
        {"context": {"x": None}, "states": {"a": {"on": {"*": {"actions": {"assign": {"x": "event.data"}}}}}}}
    )
    it = Interpreter(keeping)
    it.start()
    with pytest.raises(UsageError, match=r"`event\.data"):
        it.send("go", bad)
    with pytest.raises(UsageError, match="`input"):
        Interpreter(keeping, input={"x": bad}).start()
    kept = step(keeping, initial(keeping).snapshot, Event("go", bad)).snapshot
    with pytest.raises(SnapshotError, match=r"can't be written: `context\.x"):
        serialize(keeping, kept)


RICH: dict[str, Any] = {
    "id": "rich",
    "context": {"n": 0, "t": "x", "any": None},
    "states": {
        "on": {
            "type": "parallel",
            "states": {
                "l": {
                    "states": {
                        "a": {
                            "do": [
                                {"if": "context.n == 0", "then": [{"parallel": [{"say": "x"}, {"wait": "9s"}]}]},
                                {"assign": {"n": "1"}},
                            ],
                            "after": {"5s": "b"},
                        },
                        "b": None,
                        "h": {"type": "history"},
                    }
                },
                "r": {"states": {"a": {"invoke": {"behavior": "quiz"}}, "b": None}},
            },
            "on": {"out": "off"},
        },
        "off": {"entry": {"send": {"event": "x", "delay": "3s", "data": {"k": "1"}}}, "on": {"back": "#on.l.h"}},
    },
}


def rich() -> dict[str, Any]:
    """Return a snapshot with something under every key."""
    it = Interpreter(machine(RICH))
    for event in ("", "out", "back"):
        it.send(event) if event else it.start()
    frozen: dict[str, Any] = json.loads(json.dumps(it.snapshot()))
    assert all(frozen[key] for key in ("timers", "doing", "history", "invoked", "context"))
    return frozen


def change(data: Any, path: tuple[Any, ...], value: Any) -> dict[str, Any]:
    changed: Any = deepcopy(data)
    *way, last = path
    node = changed
    for key in way:
        node = node[key]
    if value is ...:
        del node[last]
    else:
        node[last] = value
    return dict(changed)


@for_each(
    ("path", "value", "told"),
    [
        (("version",), 2, "has version 2"),
        (("version",), ..., "lacks `version`"),
        (("machine", "hash"), 7, "`machine.hash` should be a string"),
        (("configuration",), ["on"], "active regions of `on`: 0 of 2"),
        (("configuration",), [], "0 states of `rich` are active"),
        (("configuration",), ["nowhere"], "`rich` has no state `nowhere`"),
        (("configuration", 0), "off", "`on.l` is active without `on`"),
        (("context", "n"), ..., "`context` lacks `n`"),
        (("context", "n"), "text", "`context.n` is a number and can't be a string"),
        (("context", "m"), 1, "`context.m` is not a key of the context"),
        (("context", "any"), float("nan"), "`context.any` is nan"),
        (("at",), "soon", "`at` should be a number"),
        (("timers", 0, "due"), float("inf"), "`timers.0.due` should be a number"),
        (("timers", 1, "kind"), "later", "should be `after`, `at`, `send` or `wait`"),
        (("timers", 1, "state"), "off", "names `off`, which is not active"),
        (("doing", "on.l.a", "place"), 9, "is 9, but should be less than 2, the number of actions"),
        (("doing", "on.l.a", "place"), 1, "no inner positions"),
        (("doing", "on.l.a", "inner", "block"), "do", "should be `then` or `else`"),
        (("doing", "on.l.a", "inner", "inner", "branches"), [None, None], "2 branches"),
        (("doing", "on.r.a"), {}, "is not an active state with a `do`"),
        (("history", "on.l.h"), ["on.r.a"], "never active there"),
        (("history", "on.l.h"), ["on.l.a", "on.l.b"], "never active there"),
        (("history", "on.l"), ["on.l.a"], "is not a history state"),
        (("counters", "timers"), -1, "`counters.timers` should be a whole number"),
        (("invoked", "quiz", "state"), "on.l.a", "which is not active or does not invoke that id"),
        (("invoked", "quiz", "snapshot", "at"), None, "`invoked.quiz.snapshot.at` should be a number"),
    ],
)
def test_a_damaged_snapshot_is_refused_with_the_place(path: tuple[Any, ...], value: Any, told: str) -> None:
    with pytest.raises(SnapshotError) as caught:
        Interpreter.restore(machine(RICH), change(rich(), path, value))
    assert told in str(caught.value)


def nodes(value: Any, path: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    items = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, item in items:
        yield (*path, key)
        yield from nodes(item, (*path, key))


ODD: list[Any] = [
    ..., None, True, -1, 0, 10**400, 1.5, float("nan"), float("inf"), "", "on.l.b", "off", [], [[]], {}, {"a": 1},
]  # fmt: skip
RICHES, FULL = machine(RICH), rich()


@pytest.mark.slow
@settings(max_examples=300, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(st.lists(st.tuples(st.sampled_from(list(nodes(FULL))), st.sampled_from(ODD)), min_size=1, max_size=3))
@example([])
def test_any_damage_is_refused_or_does_no_harm(damages: list[tuple[tuple[Any, ...], Any]]) -> None:
    broken: Any = FULL
    for path, value in damages:
        with suppress(KeyError, TypeError, IndexError):  # an earlier damage removed it
            broken = change(broken, path, value)
    try:
        it = Interpreter.restore(RICHES, broken)
    except SnapshotError:
        return
    with suppress(LumenError):
        for event in ("done.command.d1", "done.command.d2", "out", "back", "x"):
            it.send(event)
            it.clock.wait(it.clock.now() + 10.0)
        json.dumps(it.snapshot(), allow_nan=False)


@for_each("data", [None, [], "text", 7, {}, {"version": 1}, {"version": {}}, [[[[]]]]])
def test_what_is_no_snapshot_at_all(data: Any) -> None:
    with pytest.raises(SnapshotError):
        Interpreter.restore(machine(RICH), data)


def test_a_snapshot_without_end_is_refused() -> None:
    endless: dict[str, Any] = rich()
    endless["context"]["any"] = endless
    deep: Any = None
    for _ in range(100_000):
        deep = [deep]
    for broken in (endless, change(rich(), ("context", "any"), 0) | {"doing": endless}):
        with pytest.raises(SnapshotError):
            Interpreter.restore(machine(RICH), broken)
    with pytest.raises(SnapshotError, match="nested too deeply"):
        Interpreter.restore(machine(RICH), {**rich(), "context": {"n": 0, "t": "x", "any": deep}})


def test_an_assignment_within_a_map_leaves_the_map_to_those_who_have_it() -> None:
    deep = {"visitor": {"at": {"room": 1}}}
    going = {"go": {"actions": {"assign": {"visitor.at.room": "context.visitor.at.room + 1"}}}}
    chart = machine({"context": deep, "states": {"a": {"on": going, "entry": {"assign": {"visitor.at.floor": 2}}}}})
    first = initial(chart).snapshot
    second = step(chart, first, Event("go")).snapshot
    assert second.context == {"visitor": {"at": {"room": 2, "floor": 2}}}
    assert first.context == {"visitor": {"at": {"room": 1, "floor": 2}}}
    assert initial(chart).snapshot.context == first.context
    assert chart.context == deep == {"visitor": {"at": {"room": 1}}}
