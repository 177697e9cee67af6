"""Laws of every machine, `do` and timers included; and every fault put into a sound one is reported at its place."""

import json
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from copy import deepcopy
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from lumen.errors import LumenError, ProjectError
from lumen.language.diagnostics import Diagnostic
from lumen.language.events import Event
from lumen.language.nanoseconds import to_the_nanosecond
from lumen.statechart import Interpreter, Machine, Snapshot, Step, deserialize, due, initial, serialize, step
from tests.statechart.oracle.generating import Data, happenings, machine_data

PATIENT = settings(deadline=None, suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large])
Happenings = list[tuple[str, Any] | None]


def happen(snapshot: Snapshot, happening: tuple[str, Any] | None, number: int) -> Event:
    """Return an event from outside, or by turns the next timer, an answer and a refusal of the last command awaited."""
    if happening is not None:
        return Event(*happening, to_the_nanosecond(snapshot.at + 0.05))  # as a clock shows it
    if number % 3 == 0 and (event := due(snapshot)):
        return event
    kind = "done" if number % 3 == 1 else "error"
    return Event(f"{kind}.command.d{snapshot.counters.awaited}", None, snapshot.at)


def run(machine: Machine, events: Happenings, snapshot: Snapshot | None = None, first: int = 0) -> list[Step]:
    """Return the steps until the end, or until the machine does not come to rest."""
    steps: list[Step] = []
    with suppress(LumenError):
        if snapshot is None:
            steps.append(initial(machine))
            snapshot = steps[-1].snapshot
        for number, happening in enumerate(events[first:], first):
            steps.append(step(machine, snapshot, happen(snapshot, happening, number)))
            snapshot = steps[-1].snapshot
    return steps


def as_data(steps: list[Step], machine: Machine) -> list[Any]:
    """Return steps as data, in which those of different Machine objects can be compared."""
    return [(*s[:4], s.raised, serialize(machine, s.snapshot)) for s in steps]


@pytest.mark.slow
@settings(PATIENT, max_examples=40)
@given(machine_data(deeds=True), happenings, st.integers(0, 10))
def test_what_was_on_the_disk_goes_on_as_if_it_had_not_been(data: Data, events: Happenings, moment: int) -> None:
    machine, again = Machine.from_dict(data), Machine.from_dict(deepcopy(data))
    steps = run(machine, events)
    if steps:
        moment = min(moment, len(steps) - 1)
        saved = json.dumps(serialize(machine, steps[moment].snapshot))
        later = run(again, events, deserialize(again, json.loads(saved)), moment)
        assert as_data(later, again) == as_data(steps[moment + 1 :], machine)
        with suppress(LumenError):
            assert json.dumps(Interpreter.restore(again, json.loads(saved)).snapshot()) == settled(again, saved)


def settled(machine: Machine, saved: str) -> str:
    """Return the snapshot after everything that is due at its own time."""
    snapshot = deserialize(machine, json.loads(saved))
    while (event := due(snapshot)) and event.at <= snapshot.at:
        snapshot = step(machine, snapshot, event).snapshot
    return json.dumps(serialize(machine, snapshot))


@pytest.mark.slow
@settings(PATIENT, max_examples=40)
@given(machine_data(deeds=True), happenings, happenings)
def test_what_happened_elsewhere_does_not_matter(data: Data, events: Happenings, others: Happenings) -> None:
    """A machine's caches do not affect a snapshot: it continues as it does in a machine with empty caches."""
    used, fresh = Machine.from_dict(data), Machine.from_dict(data)
    run(used, others)
    assert as_data(run(used, events), used) == as_data(run(fresh, events), fresh)
    assert run(used, events) == run(used, events)


WRONG = [
    None,
    True,
    7,
    -0.5,
    float("nan"),
    "",
    "no such thing",
    "#nowhere",
    ".",
    "a..b",
    [],
    [[]],
    {},
    {"a": 1},
    {"": None},
]


def places(value: Any, path: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    """Yield the path of every node but the root."""
    items = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, item in items:
        yield (*path, key)
        yield from places(item, (*path, key))


def changed(data: Data, path: tuple[Any, ...], change: Callable[[Any, Any], None]) -> Data:
    copy = deepcopy(data)
    node: Any = copy
    for key in path[:-1]:
        node = node[key]
    change(node, path[-1])
    return copy


@pytest.mark.slow
@settings(PATIENT, max_examples=100)
@given(st.data(), machine_data(deeds=True))
def test_anything_wrong_anywhere_is_told_or_runs(data: st.DataObject, sound: Data) -> None:
    path = data.draw(st.sampled_from(list(places(sound))))
    value = data.draw(st.sampled_from(WRONG))

    def replace(node: Any, key: Any) -> None:
        node[key] = value

    def rename(node: Any, key: Any) -> None:
        if isinstance(node, dict):
            node[data.draw(st.sampled_from(["on", "states", "type", "x", ""]))] = node.pop(key)

    broken = changed(sound, path, data.draw(st.sampled_from([replace, rename])))
    machine, diagnostics = built(broken)
    assert all(d.code and d.message and d.place.file.startswith("machine") for d in diagnostics)
    if machine:
        run(machine, [("a", None), None, ("b.c", {"k": 1}), None, None])


def built(data: Data) -> tuple[Machine | None, Sequence[Diagnostic]]:
    """Return the machine, or None, and the findings."""
    try:
        return Machine.from_dict(data), ()
    except ProjectError as error:
        return None, error.diagnostics


@pytest.mark.slow
@settings(PATIENT, max_examples=60)
@given(st.data(), machine_data())
def test_a_target_that_is_nowhere_is_told_at_its_place(data: st.DataObject, sound: Data) -> None:
    targets = [path for path in places(sound) if path[-1] == "target"]
    if targets:
        path = data.draw(st.sampled_from(targets))
        broken = changed(sound, path, lambda node, key: node.update({key: "#nowhere"}))
        with pytest.raises(ProjectError) as caught:
            Machine.from_dict(broken)
        told = {(d.code, d.place.file) for d in caught.value.diagnostics}
        assert ("unknown-state", f"machine ({'.'.join(map(str, path))})") in told


@pytest.mark.slow
@settings(PATIENT, max_examples=60)
@given(st.data(), machine_data())
def test_an_id_used_twice_is_told(data: st.DataObject, sound: Data) -> None:
    states = [path for path in places(sound) if len(path) > 1 and path[-2] == "states"]
    first, second = data.draw(st.lists(st.sampled_from(states), min_size=2, max_size=2, unique=True))
    broken = changed(sound, first, lambda node, key: node[key].update(id="twice"))
    broken = changed(broken, second, lambda node, key: node[key].update(id="twice"))
    with pytest.raises(ProjectError) as caught:
        Machine.from_dict(broken)
    assert "duplicate-id" in {d.code for d in caught.value.diagnostics}


@pytest.mark.rest
@pytest.mark.slow
def test_ten_thousand_states_at_once_run() -> None:
    regions = {
        f"r{i}": {"entry": {"log": "in"}, "states": {"a": {"on": {"go": "b"}, "exit": {"log": "out"}}, "b": None}}
        for i in range(3_333)
    }
    machine = Machine.from_dict({"type": "parallel", "states": regions})
    assert len(machine.states) == 10_000
    first = initial(machine)
    assert len(first.commands) == 3_333
    assert len(step(machine, first.snapshot, Event("go")).entered) == 3_333


@pytest.mark.parametrize("levels", [15, 40, 200])
def test_deep_nesting_runs_or_is_told(levels: int) -> None:
    data: Data = {"states": {"a": {"on": {"up": {"target": "#top"}}}}}
    for _ in range(levels - 1):
        data = {"states": {"a": data}}
    machine, diagnostics = built({"id": "top", **data})
    if machine:
        assert len(step(machine, initial(machine).snapshot, Event("up")).entered) == levels
    else:
        assert {d.code for d in diagnostics} == {"too-large"}
        assert levels == 200


@pytest.mark.parametrize(("target", "sound"), [("#p.l.b", False), ("#p.shallow", False), ("#p", True), ("#q.a", True)])
def test_a_history_speaks_for_all_of_its_parent(target: str, sound: bool) -> None:
    side = {"states": {"a": None, "b": None}}
    histories = {"h": {"type": "history", "history": "deep"}, "shallow": {"type": "history"}}
    both = {"p": {"type": "parallel", "states": {"l": side, "r": side, **histories}}, "q": side}
    go = {"target": ["#p.h", target]}
    machine, diagnostics = built({"type": "parallel", "states": both, "on": {"go": go}})
    assert [d.code for d in diagnostics] == [] if sound else ["conflicting-targets"]
    assert machine is None or len(step(machine, initial(machine).snapshot, Event("go")).snapshot.configuration) == 7
