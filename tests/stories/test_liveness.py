"""Keys of the context that exploration may ignore, and keys without which it would miss a state."""

from typing import Any

import pytest

from lumen.insight.exploration.liveness import Liveness
from lumen.insight.exploration.search import StateSpaceSearch
from lumen.statechart import Machine

EVENTS: dict[str, Any] = {name: {"const": None} for name in "abcd"} | {"x": {"enum": [0, 1]}}
SET = {"actions": {"assign": {"n": 1}}}
READ = {"guard": "context.n == 1", "target": "found"}


def search(states: dict[str, Any]) -> StateSpaceSearch:
    machine = Machine.from_dict({"context": {"n": 0}, "initial": next(iter(states)), "states": states})
    found = StateSpaceSearch(machine, EVENTS)
    for _ in found.expand(1000):
        pass
    return found


def liveness(states: dict[str, Any]) -> Liveness:
    return Liveness(Machine.from_dict({"context": {"n": 0}, "initial": next(iter(states)), "states": states}))


HOME: dict[str, Any] = {
    "initial": "p",
    "on": {"c": "away"},
    "states": {"p": {"on": {"a": READ}}, "found": {}, "back": {"id": "back", "type": "history", "target": "p"}},
}


def test_what_is_read_where_a_history_leads_back_to_counts() -> None:
    assert "home.found" in search({"home": HOME, "away": {"on": {"b": SET, "d": "#back"}}}).entered


def test_what_a_history_can_not_lead_back_to_does_not_count() -> None:
    back = HOME["states"]["back"] | {"target": "rest"}
    home = {**HOME, "states": {**HOME["states"], "back": back, "rest": {}}}
    live = liveness({"home": home, "away": {"on": {"b": SET, "d": "#back"}}})
    assert live.of(frozenset(("away",)), {"home.back": ("home.p",)}) == {"n"}
    assert live.of(frozenset(("away",)), {"home.back": ("home.rest",)}) == frozenset()


def test_what_is_read_where_a_shallow_history_begins_anew_counts() -> None:
    asks = {"on": {"a": {**READ, "target": "#found"}, "b": "u"}}
    inner = {"initial": "t", "states": {"t": asks, "u": {"on": {"b": SET}}}}
    home = {**HOME, "states": {"p": inner, "found": {"id": "found"}, "back": HOME["states"]["back"]}}
    assert "found" in search({"home": home, "away": {"on": {"d": "#back"}}}).entered


@pytest.mark.parametrize(
    ("guard", "live"),
    [("event.data == 1", False), ("event.data == 1 && true", False), ("event.data == 1 || true", True)],
)
def test_a_key_keeps_its_value_unless_the_new_one_is_sure(guard: str, live: bool) -> None:
    """A value that a true guard surely computed can be computed again; any other computation may fail."""
    way = {"guard": guard, "target": "asks", "actions": {"assign": {"n": "event.data"}}}
    states = {"first": {"on": {"b": SET, "x": way}}, "asks": {"on": {"a": READ}}, "found": {}}
    assert (liveness(states).of(frozenset(("first",)), {}) == {"n"}) == live


def test_regions_that_a_transition_does_not_enter_are_not_looked_into() -> None:
    one = {"initial": "p", "states": {"p": {"id": "p", "on": {"a": "q"}}, "q": {"on": {"a": "#p"}}}}
    two = {"initial": "r", "states": {"r": {"on": {"a": READ, "b": SET}}, "found": {}}}
    live = liveness({"both": {"type": "parallel", "states": {"one": one, "two": two}}, "out": {"on": {"a": "#p"}}})
    assert live.of(frozenset(("p",)), {}) == frozenset()
    assert live.of(frozenset(("out",)), {}) == {"n"}
