"""The fast path gives the step that the whole algorithm gives, or none."""

from contextlib import suppress
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lumen.errors import LumenError
from lumen.interpreters.statechart import Snapshot, Step
from lumen.interpreters.statechart.compiled_machine import compiled
from lumen.interpreters.statechart.external_events import process
from lumen.interpreters.statechart.invocations import open_context
from lumen.statechart import Event, Machine, initial, step

GUARDS = [
    "true",
    "context.n % 2 == 0",
    "context.n < 3 || event.data.x",
    "event.data.x > 1",
    "event.data.nothing",
    "In('r0.a')",
    "state.path == 'r0.a'",
    "hour() == 0",
    "context.n",
]
ASSIGNS = [
    {"n": "context.n + 1"},
    {"n": "context.n + 1", "m": "context.n"},
    {"n": "event.data.x"},
    {"n": "'text'"},
    {"m": [1, {"k": "context.n"}]},
    {"m": "1 / context.n"},
    {"m": "state.path"},
    {"m": "In('r1.b')"},
    {"m.k": "context.n"},
    {"m": {"k": {"x": 1}}, "m.k.x": "context.m.k.x + context.n"},
]
ROWS = st.fixed_dictionaries(
    {},
    optional={
        "target": st.sampled_from(["a", "b", "#r0.a", "#r1", "#r1.b"]),
        "guard": st.sampled_from(GUARDS),
        "actions": st.lists(st.sampled_from(ASSIGNS).map(lambda values: {"assign": values}), max_size=2),
        "reenter": st.booleans(),
    },
)


@st.composite
def machines(draw: st.DrawFn) -> Machine:
    """A random machine of two regions or states; it checks and assigns, and seldom does anything else."""

    def leaf() -> dict[str, Any]:
        data: dict[str, Any] = {
            "on": draw(st.dictionaries(st.sampled_from(["e", "f", "*"]), st.lists(ROWS, max_size=2)))
        }
        for key in ("entry", "exit"):
            if draw(st.integers(0, 3)) == 0:
                data[key] = {"assign": draw(st.sampled_from(ASSIGNS))}
        if draw(st.integers(0, 3)) == 0:
            data["after"] = {draw(st.sampled_from(["1s", "9s", "{{ context.n + 1 }}s"])): {"target": "b"}}
        rare = draw(st.integers(0, 30))
        return data | {0: {"entry": {"log": "x"}}, 1: {"always": {"guard": "context.n > 4", "target": "a"}}}.get(
            rare, {}
        )

    regions = {
        f"r{i}": {"states": {"a": leaf(), "b": leaf()}, "on": {"f": draw(st.lists(ROWS, max_size=1))}} for i in (0, 1)
    }
    for region in regions.values():
        for row in region["on"]["f"]:
            if row.get("target") in ("a", "b"):
                row["target"] = f".{row['target']}"
    kind = draw(st.sampled_from(["parallel", "compound"]))
    return Machine.from_dict({"type": kind, "context": {"n": 0, "m": None}, "states": regions})


def in_full(machine: Machine, snapshot: Snapshot, event: Event) -> Step:
    """The step without the fast path."""
    return process(open_context(compiled(machine), snapshot, event, max(event.at, snapshot.at)), event)


EVENTS = st.builds(
    Event,
    st.sampled_from(["e", "f", "g.h"]),
    st.sampled_from([None, {"x": 1}, {"x": 2.5}, {"x": True}]),
    st.floats(0, 9),
)


@settings(max_examples=200, deadline=None)
@given(machines(), st.lists(EVENTS, max_size=15))
def test_a_shortcut_gives_the_step_of_the_whole_algorithm(machine: Machine, events: list[Event]) -> None:
    with suppress(LumenError):  # its `always` may go round without end
        snapshot = initial(machine).snapshot
        for event in events:
            taken = in_full(machine, snapshot, event)
            assert step(machine, snapshot, event) == taken
            snapshot = taken.snapshot


ADD = {"assign": {"n": "context.n + 1"}}
RING = {f"s{i}": {"on": {"go": {"guard": "context.n < 9", "target": f"s{(i + 1) % 3}"}}} for i in range(3)}
COUNTING = {
    f"s{i}": {"on": {"go": f"s{(i + 1) % 3}"}, "entry": ADD, "exit": ADD, "after": {"2s": "s0"}} for i in range(3)
}
PLAIN: dict[str, dict[str, Any]] = {
    "a ring": {"states": RING},
    "counting on the way": {"states": COUNTING},
    "two regions": {"type": "parallel", "states": {"l": {"states": RING}, "r": {"states": RING}}},
}


@pytest.mark.parametrize("name", PLAIN)
def test_plain_steps_are_taken_short(name: str) -> None:
    machine = Machine.from_dict({"context": {"n": 0}, **PLAIN[name]})
    snapshot = initial(machine).snapshot
    for event in (Event("go", at=1.0), Event("nothing")):
        short = compiled(machine).fast_paths.step(snapshot, event)
        assert short == in_full(machine, snapshot, event)
        assert short is not None
