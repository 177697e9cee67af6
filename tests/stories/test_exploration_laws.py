"""Laws of exploring: facts that it ignores do not affect the reachable states."""

from collections.abc import Sequence
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lumen.insight.exploration.liveness import Liveness
from lumen.insight.exploration.search import StateSpaceSearch
from lumen.statechart import Machine

NAMES = "pqrs"
EVENTS = {"a": {"enum": [0, 1, 2]}, "b": {"const": None}}
VALUES = st.sampled_from([0, 1, 2, "(context.n + 1) % 3", "context.m", "2 - context.n", "context.map.x", "event.data"])
KEYS = {"n": VALUES, "m": VALUES, "map": VALUES.map(lambda value: {"x": value, "y": 0}), "map.x": VALUES}
WAYS_BACK = st.sampled_from(["shallow", "deep"])
READ = st.sampled_from(["context.n", "context.m", "context.map.x", "context.map.y", "event.data"])

assigns = st.fixed_dictionaries({"assign": st.fixed_dictionaries({}, optional=KEYS).filter(bool)})


@st.composite
def rows(draw: st.DrawFn, names: Sequence[str]) -> Any:
    row: dict[str, Any] = {"target": draw(st.sampled_from(names))}
    if draw(st.booleans()):
        row["guard"] = f"{draw(READ)} == {draw(st.integers(0, 2))}"
    if draw(st.booleans()):
        row["actions"] = draw(assigns)
    return row


@st.composite
def regions(draw: st.DrawFn, letters: str = NAMES) -> Any:
    names = letters[: draw(st.integers(1, len(letters)))]
    states: dict[str, Any] = {name: {} for name in names}
    for state in states.values():
        state["on"] = draw(st.dictionaries(st.sampled_from("ab"), st.lists(rows(names), min_size=1, max_size=2)))
        if draw(st.booleans()):
            state["entry"] = draw(assigns)
        if draw(st.integers(0, 3)) == 0:
            state["do"] = [{"say": "x"}, *([draw(assigns)] if draw(st.booleans()) else [])]
            state["onDone"] = draw(rows(names))
    return {"initial": letters[0], "states": states}


def walked(machine: Machine) -> StateSpaceSearch:
    search = StateSpaceSearch(machine, EVENTS)
    for _ in search.expand(5000):
        pass
    assert not search.waiting
    return search


def same_with_and_without(data: Any) -> None:
    """Check that the same states and transitions are reached, whether or not keys are left out of account."""
    lively = walked(Machine.from_dict(data))
    original = Liveness.of
    Liveness.of = lambda self, configuration, history: self.keys  # type: ignore[method-assign]
    try:
        full = walked(Machine.from_dict(data))
    finally:
        Liveness.of = original  # type: ignore[method-assign]
    assert {s.names for s in lively.nodes.values()} == {s.names for s in full.nodes.values()}
    assert lively.taken == full.taken
    assert len(lively.nodes) <= len(full.nodes)


@pytest.mark.slow
@settings(max_examples=60, deadline=None)
@given(regions(), regions())
def test_keys_that_can_not_matter_any_more_do_not_matter(one: Any, other: Any) -> None:
    data = {
        "type": "parallel",
        "context": {"n": 0, "m": 1, "map": {"x": 0, "y": 1}},
        "states": {"one": one, "two": other},
    }
    same_with_and_without(data)


@st.composite
def homes(draw: st.DrawFn) -> Any:
    """Return a state with shallow or deep history, and two outside that lead back."""
    home = draw(regions())
    if draw(st.booleans()):
        home["states"]["p"] = draw(regions("tuv")) | {"on": home["states"]["p"]["on"]}
    home["states"]["back"] = {"id": "back", "type": "history", "target": "p", "history": draw(WAYS_BACK)}
    states: dict[str, Any] = {"home": home | {"on": draw(ways(("away", "far")))}}
    for name in ("away", "far"):
        states[name] = {"id": name, "on": draw(ways(("home", "#back", "away", "far")))}
        if draw(st.booleans()):
            states[name]["entry"] = draw(assigns)
    states["home"]["id"] = "home"
    return {"initial": "home", "states": states}


def ways(names: tuple[str, ...]) -> st.SearchStrategy[Any]:
    return st.dictionaries(st.sampled_from("ab"), st.lists(rows(names), min_size=1, max_size=2))


@pytest.mark.slow
@settings(max_examples=60, deadline=None)
@given(homes(), regions())
def test_a_history_leads_back_to_what_it_remembers_and_to_nothing_else(one: Any, other: Any) -> None:
    data = {
        "type": "parallel",
        "context": {"n": 0, "m": 1, "map": {"x": 0, "y": 1}},
        "states": {"one": one, "two": other},
    }
    same_with_and_without(data)
