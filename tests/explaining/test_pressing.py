"""Buttons: which are shown, which can be pressed, and why not."""

from collections import Counter
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings

from lumen.insight.explaining.pressing import pressed, shown_buttons, takes
from lumen.language.events import Event
from lumen.statechart import Machine, initial, step
from tests.explaining.running import inputs, live, timed
from tests.statechart.oracle.generating import EVENTS, Data, machine_data

pytestmark = pytest.mark.rest  # expensive

NEXT, STOP = {"label": {"en": "Next", "de": "Weiter"}, "event": "next", "key": "n"}, {"label": "Stop", "event": "stop"}
TOUR: dict[str, Any] = {
    "context": {"n": 0},
    "buttons": [STOP, {"label": "Wait", "event": "wait", "key": "n"}],
    "states": {
        "hall": {
            "buttons": [NEXT, {"label": "Organ", "event": "show", "data": {"what": "organ"}}],
            "on": {
                "next": {"guard": "context.n < 1", "target": "hall", "actions": {"assign": {"n": "context.n + 1"}}},
                "show": {"guard": "event.data.what == 'clock'", "target": "shown"},
                "leave": "shown",
            },
        },
        "shown": {"buttons": [{"label": "Halt", "event": "stop"}], "on": {"stop": "hall", "wait": "hall"}},
    },
}
QUICK = settings(
    max_examples=40, deadline=None, suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large]
)


def shown(*events: str) -> dict[str, tuple[bool, str, str]]:
    machine = Machine.from_dict(TOUR)
    snapshot = initial(machine).snapshot
    for event in events:
        snapshot = step(machine, snapshot, Event(event)).snapshot
    return {
        next(iter(one.button.label.values())): (one.enabled, one.reason, one.key)
        for one in shown_buttons(machine, snapshot, 0.0)
    }


def test_a_button_says_why_it_can_not_be_pressed() -> None:
    assert shown() == {
        "Next": (True, "", "n"),
        "Organ": (False, "event.data.what == 'clock' is false: event.data.what is \"organ\"", ""),
        "Stop": (False, "only in shown", ""),
    }
    assert shown("next")["Next"] == (False, "context.n < 1 is false: context.n is 1", "n")


def test_one_further_in_takes_the_place_of_its_like() -> None:
    assert shown("leave") == {"Halt": (True, "", ""), "Wait": (True, "", "n")}


def test_a_button_is_pressed_by_its_name_in_any_language() -> None:
    machine = Machine.from_dict(TOUR)
    snapshot = initial(machine).snapshot
    event = pressed(machine, snapshot, " weiter", 0.0, "Aisyah")
    assert isinstance(event, Event)
    assert event.name == "next"
    assert event.cause
    assert (event.cause.kind, event.cause.sender) == ("person", "Aisyah")
    assert pressed(machine, snapshot, "stop", 0.0, "Aisyah") == "the button “stop” can't be pressed: only in shown"
    assert "did you mean `Next`?" in str(pressed(machine, snapshot, "Nxt", 0.0, "Aisyah"))


def test_buttons_of_regions_that_share_a_key_give_it_to_the_first() -> None:
    region = {"buttons": [{"label": "One", "event": "go", "key": "g"}], "on": {"go": {}}}
    other = {"buttons": [{"label": "Two", "event": "go", "key": "g"}]}
    machine = Machine.from_dict({"type": "parallel", "states": {"a": region, "b": other}})
    found = shown_buttons(machine, initial(machine).snapshot, 0.0)
    assert [(next(iter(one.button.label.values())), one.key, one.enabled) for one in found] == [
        ("One", "g", True),
        ("Two", "", True),
    ]


def test_a_button_can_be_pressed_where_its_event_is_taken() -> None:
    """More than ten buttons that can be pressed, and that can't, are met; fewer would show nothing."""
    tally: Counter[bool] = Counter()

    @QUICK
    @given(machine_data(), inputs)
    def tried(data: Data, happenings: list[Any]) -> None:
        tally.update(_tried(data, happenings))

    tried()
    assert min(tally[True], tally[False]) > 10


def _tried(data: Data, happenings: list[Any]) -> Counter[bool]:
    """Check a button for each event in the last states of a run; return how many could be pressed, and could not."""
    tally: Counter[bool] = Counter()
    buttons = [{"label": name, "event": name, "data": {"k": 1}} for name in EVENTS if "." not in name]
    machine, events = Machine.from_dict({**data, "buttons": buttons}), timed(happenings)
    for one in live(machine, events, events[-1].at)[-3:]:
        snapshot = one.step.snapshot
        for button in shown_buttons(machine, snapshot, snapshot.at):
            event = Event(button.button.event, button.button.data, snapshot.at)
            assert button.enabled == takes(step(machine, snapshot, event)) or "rest" in button.reason
            assert button.enabled == (not button.reason)
            tally[button.enabled] += 1
    return tally
