"""Controllers that move no joint: their signals, and the times and rates of them."""

from collections.abc import Mapping
from typing import Any

import pytest

from lumen.fuzzy import Controller
from lumen.fuzzy.regulation import Regulator, Signals
from lumen.language.commands import Publish
from lumen.language.events import Event


def through(outputs: Mapping[str, Any], source: Any = "sonar.left", **more: Any) -> Regulator:
    """Return a controller whose output Y, from 0 to 1, is a tenth of its input X; Z is the rest of it to 1."""
    terms = {"Lo": {"constant": 0}, "Hi": {"constant": 1}}
    data = {
        "inputs": {
            "X": {"range": [0, 10], "lock-range": True, "terms": {"Lo": {"ramp": [10, 0]}, "Hi": {"ramp": [0, 10]}}}
        },
        "outputs": {"Y": {"range": [0, 1], "terms": terms}, "Z": {"range": [0, 1], "terms": terms}},
        "rules": ["if X is Lo then Y is Lo, Z is Hi", "if X is Hi then Y is Hi, Z is Lo"],
        "operators": {"defuzzifier": "weighted-average"},
        "bind": {"inputs": {"X": source}, "outputs": outputs},
        **more,
    }
    return Regulator(Controller.from_dict(data, "line"), {("lamp", "brightness")})


def told(regulator: Regulator, xs: list[float], every: float = 0.2) -> list[Signals]:
    """Return the signals after messages with these numbers, one every `every` [s]."""
    found = []
    for i, x in enumerate(xs):
        regulator.take("sonar", {"left": x})
        found.append(regulator.signals(i * every))
    return found


def test_the_volume_is_told_first_and_after_a_step() -> None:
    volumes = [s.volume for s in told(through({"Y": "volume"}), [5, 5, 5.1, 5.21, 5.3, 9, 99])]
    assert volumes == [0.5, None, None, 0.521, None, 0.9, 1.0]


def test_a_step_of_nothing_tells_every_change() -> None:
    volumes = [s.volume for s in told(through({"Y": {"volume": True, "step": 0}}), [5, 5.001, 5.001])]
    assert volumes == [pytest.approx(0.5), pytest.approx(0.5001), None]


def test_no_more_often_than_every() -> None:
    regulator = through({"Y": "volume"}, track={"every": "1s"})
    assert [s.volume for s in told(regulator, [1, 2, 3, 4, 5, 6, 7], 0.25)] == [0.1, *[None] * 3, 0.5, None, None]


def test_nothing_as_long_as_an_input_is_missing_or_no_number() -> None:
    regulator = through({"Y": "volume"})
    for body in (None, [], {"left": "near"}, {"left": True}, {"left": float("nan")}, {"left": 10**400}, {"right": 1}):
        regulator.take("sonar", body)
        assert regulator.signals(1.0) == Signals()
    regulator.take("bumper", {"left": 1})
    assert regulator.signals(2.0) == Signals()


def test_outputs_of_one_route_make_one_message() -> None:
    lamp = {"message": "lamp.brightness", "body": {"lamp": "organ", "at": {"hall": 1}}, "step": 1 / 3}
    regulator = through({"Y": lamp, "Z": {"message": "lamp.at.height"}})
    first, second, third = told(regulator, [2, 2.01, 3])
    assert first.messages == (Publish("lamp", {"lamp": "organ", "at": {"hall": 1, "height": 0.8}, "brightness": 0}),)
    assert second.messages == ()
    assert third.messages == (Publish("lamp", {"lamp": "organ", "at": {"hall": 1, "height": 0.7}, "brightness": 0}),)


def test_whole_fields_get_integers() -> None:
    (message,) = told(through({"Y": "lamp.brightness"}), [9])[0].messages
    assert repr(message.body) == "{'brightness': 1}"


def test_the_context_is_set_by_an_event() -> None:
    first, second = told(through({"Y": {"context": "mood"}, "Z": {"context": "calm"}}), [2, 2.1])
    assert first.events == (Event("controller.line", {"mood": 0.2, "calm": 0.8}, 0.0),)
    assert second.events == ()


def test_a_threshold_is_crossed_once_until_it_is_left_for_good() -> None:
    regulator = through({"Y": {"event": "near", "above": 0.7}})
    happened = [bool(s.events) for s in told(regulator, [7, 7.1, 9, 7.1, 6.9, 7.1, 6.6, 7, 6.4, 7.1])]
    assert happened == [False, True, False, False, False, False, False, False, False, True]


def test_a_threshold_from_above() -> None:
    regulator = through({"Y": {"event": "far", "below": 0.3, "hysteresis": 0.2}})
    events = [s.events for s in told(regulator, [2, 4, 2, 5, 2])]
    assert [len(e) for e in events] == [1, 0, 0, 0, 1]
    assert events[0] == (Event("far", {"value": pytest.approx(0.2)}, 0.0),)


def test_inputs_from_the_context_of_the_nearest_behaviour_that_has_the_key() -> None:
    regulator = through({"Y": "volume"}, {"context": "level"})
    regulator.know([{}, {"level": 3}, {"level": 7}])
    assert regulator.signals(0.0).volume == 0.3
    regulator.know([{"level": "loud"}])
    assert regulator.signals(1.0) == Signals()


def test_another_version_goes_on_with_what_was_known_and_told() -> None:
    before = through({"Y": "volume", "Z": {"event": "near", "above": 0.1}})
    told(before, [5])
    after = through({"Y": "volume", "Z": {"event": "near", "above": 0.1}}, track={"every": "500ms"})
    after.succeed(before)
    assert after.signals(0.3) == Signals(), "nothing has changed"
    bound = through({"Y": {"context": "mood"}, "Z": {"event": "near", "above": 0.2}})
    bound.succeed(after)
    (mood, near) = bound.signals(0.4).events
    assert (mood.data, near.name) == ({"mood": 0.5}, "near"), "what is bound anew is told anew"


def test_where_no_rule_fires_nothing_is_told() -> None:
    regulator = through({"Y": "volume"}, rules=["if X is Hi then Y is Hi, Z is Lo"])
    assert [s.volume for s in told(regulator, [0, 5])] == [None, 1.0]
