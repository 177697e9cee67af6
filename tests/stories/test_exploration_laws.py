"""Laws of exploring: what is left out of account changes nothing of what can be reached."""

from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lumen.interpreters.exploration.liveness import Liveness
from lumen.interpreters.exploration.search import StateSpaceSearch
from lumen.statechart import Machine

NAMES = "pqrs"
EVENTS = {"a": {"const": None}, "b": {"const": None}}
VALUES = st.sampled_from([0, 1, 2, "(context.n + 1) % 3", "context.m", "2 - context.n", "context.map.x"])
KEYS = {"n": VALUES, "m": VALUES, "map": VALUES.map(lambda value: {"x": value, "y": 0}), "map.x": VALUES}
READ = st.sampled_from(["n", "m", "map.x", "map.y"])

assigns = st.fixed_dictionaries({"assign": st.fixed_dictionaries({}, optional=KEYS).filter(bool)})


@st.composite
def rows(draw: st.DrawFn, names: str) -> Any:
    row: dict[str, Any] = {"target": draw(st.sampled_from(names))}
    if draw(st.booleans()):
        row["guard"] = f"context.{draw(READ)} == {draw(st.integers(0, 2))}"
    if draw(st.booleans()):
        row["actions"] = draw(assigns)
    return row


@st.composite
def regions(draw: st.DrawFn) -> Any:
    names = NAMES[: draw(st.integers(1, 4))]
    states: dict[str, Any] = {name: {} for name in names}
    for state in states.values():
        state["on"] = draw(st.dictionaries(st.sampled_from("ab"), st.lists(rows(names), min_size=1, max_size=2)))
        if draw(st.booleans()):
            state["entry"] = draw(assigns)
        if draw(st.integers(0, 3)) == 0:
            state["do"] = [{"say": "x"}, *([draw(assigns)] if draw(st.booleans()) else [])]
            state["onDone"] = draw(rows(names))
    return {"initial": "p", "states": states}


def walked(machine: Machine) -> StateSpaceSearch:
    search = StateSpaceSearch(machine, EVENTS)
    for _ in search.expand(5000):
        pass
    assert not search.waiting
    return search


@pytest.mark.slow
@settings(max_examples=60, deadline=None)
@given(regions(), regions())
def test_keys_that_can_not_matter_any_more_do_not_matter(one: Any, other: Any) -> None:
    data = {
        "type": "parallel",
        "context": {"n": 0, "m": 1, "map": {"x": 0, "y": 1}},
        "states": {"one": one, "two": other},
    }
    lively = walked(Machine.from_dict(data))
    original = Liveness.of
    Liveness.of = lambda self, configuration: self.keys  # type: ignore[method-assign]
    try:
        full = walked(Machine.from_dict(data))
    finally:
        Liveness.of = original  # type: ignore[method-assign]
    assert {s.names for s in lively.nodes.values()} == {s.names for s in full.nodes.values()}
    assert lively.taken == full.taken
    assert len(lively.nodes) <= len(full.nodes)
