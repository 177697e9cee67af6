"""Exploration of small behaviours: what it finds, what it does not, and stories that lead there."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from lumen.cli.main import main
from lumen.expressions import parse_expression
from lumen.insight.exploration import Exploration, explore
from lumen.insight.exploration.samples import phrases_at, samples
from lumen.statechart import Machine
from tests.tables import for_each

SAID = {"type": "object", "properties": {"text": {"type": "string"}}, "required": ["text"]}
GO: dict[str, Any] = {"go": None, "back": None, "heard": SAID}


def walked(
    states: dict[str, Any], *, events: dict[str, Any] = GO, home: str = "", bound: int = 1000, **more: Any
) -> Exploration:
    machine = Machine.from_dict({"initial": next(iter(states)), "states": states, **more})
    return explore(machine, events, home=home, bound=bound)


def found(exploration: Exploration) -> list[tuple[str, str, int]]:
    """Return the kind, the state and the number of moves of each finding."""
    return [(f.kind, f.state, len(f.path) - 1) for f in exploration.findings]


def test_a_ring_is_well() -> None:
    assert found(walked({"a": {"on": {"go": "b"}}, "b": {"on": {"back": "a"}}})) == []


def test_a_dead_end_by_the_shortest_way() -> None:
    states = {
        "a": {"on": {"go": "b", "heard": {"guard": "event.data.text == 'now'", "target": "end"}}},
        "b": {"on": {"go": "end", "back": "a"}},
        "end": {"on": {"go": {"actions": {"log": "no"}}}},
    }
    assert found(walked(states)) == [("dead-end", "end", 1)]


def test_a_final_state_is_no_dead_end() -> None:
    assert found(walked({"a": {"on": {"go": "end"}}, "end": {"type": "final"}})) == []


def test_no_way_back_from_a_ring_of_its_own() -> None:
    states = {"a": {"on": {"go": "b"}}, "b": {"on": {"go": "c"}}, "c": {"on": {"go": "b"}}}
    assert found(walked(states)) == [("no-way-back", "b", 1), ("no-way-back", "c", 2)]
    assert found(walked(states, home="b")) == []


def test_what_is_awaited_ends_well_and_badly() -> None:
    states = {
        "a": {"on": {"go": "b"}},
        "b": {"do": [{"say": "Hello"}, {"play": "dance"}], "onDone": "a", "onError": "stuck"},
        "stuck": {},
    }
    [finding] = walked(states).findings
    assert (finding.kind, finding.state) == ("dead-end", "stuck")
    assert [stay.stimulus.kind for stay in finding.path if stay.stimulus] == ["event", "failed"]


def test_a_do_that_nobody_awaits_the_end_of_is_a_dead_end() -> None:
    assert found(walked({"a": {"on": {"go": "b"}}, "b": {"do": {"say": "Hello"}}})) == [("dead-end", "b", 1)]


def test_a_row_is_tried_with_a_sentence_that_no_other_row_of_its_state_takes() -> None:
    """`no no problems` is not a refusal of `fine`: that phrase has its own negation."""
    heard = {"type": "object", "properties": {"result": {"type": "string"}}, "required": ["result"]}
    rows = {"fine": {"actions": {"log": "fine"}}, "not fine": "refused"}
    states = {"a": {"hears": rows}, "refused": {"on": {"back": "a"}}}
    phrases = {"fine": {"en": ["no problems", "splendid"]}, "negations": {"en": ["no", "not"]}}
    exploration = walked(states, events={"heard": heard, "back": None}, phrases=phrases)
    assert found(exploration) == []
    assert exploration.never_taken == ()


def test_time_leads_out() -> None:
    assert found(walked({"a": {"on": {"go": "b"}}, "b": {"after": {"5s": "a"}}})) == []


def test_of_two_timers_of_a_state_only_the_shorter_ends() -> None:
    states = {"a": {"on": {"go": "b"}}, "b": {"after": {"5s": "a", "9s": "stuck"}}, "stuck": {}}
    exploration = walked(states)
    assert found(exploration) == []
    assert exploration.never_entered == ("stuck",)
    assert [t.delay for t in exploration.never_taken] == [9.0]


def test_a_counter_has_an_end() -> None:
    states = {
        "a": {
            "on": {
                "go": [
                    {"guard": "context.n > 3", "target": "stuck"},
                    {"target": "a", "actions": {"assign": {"n": "context.n + 1"}}},
                ]
            }
        },
        "stuck": {},
    }
    exploration = walked(states, context={"n": 0, "idle": 0})
    assert found(exploration) == [("dead-end", "stuck", 5)]
    assert exploration.complete


def test_a_counter_nobody_looks_at_is_not_counted() -> None:
    states = {"a": {"on": {"go": {"target": "a", "actions": {"assign": {"n": "context.n + 1"}}}}}}
    assert walked(states, context={"n": 0}).configurations == 1


def test_a_key_given_a_new_value_before_it_is_read_does_not_count() -> None:
    """The tries are forgotten on the way back to `a`: `b` after one try or two is the same."""
    states = {
        "a": {"entry": {"assign": {"n": 0}}, "on": {"go": "ask"}},
        "ask": {
            "on": {
                "heard": [
                    {"guard": "context.n < 2", "target": "ask", "actions": {"assign": {"n": "context.n + 1"}}},
                    {"target": "b"},
                ],
                "go": "b",
            }
        },
        "b": {"on": {"back": "a"}},
    }
    exploration = walked(states, context={"n": 0})
    assert (exploration.configurations, exploration.never_taken) == (5, ())
    assert found(exploration) == []


def test_a_key_read_in_another_region_counts() -> None:
    regions = {
        "one": {"initial": "a", "states": {"a": {"on": {"go": {"actions": {"assign": {"on": "true"}}}}}}},
        "two": {
            "initial": "x",
            "states": {"x": {"on": {"back": {"guard": "context.on", "target": "stuck"}}}, "stuck": {}},
        },
    }
    machine = Machine.from_dict({"type": "parallel", "context": {"on": False}, "states": regions})
    exploration = explore(machine, GO)
    assert exploration.never_entered == ()
    assert "two.stuck" in {finding.state for finding in exploration.findings}


@for_each(
    "guard",
    [
        "heard(event.data.text, 'dance')",
        "!heard(event.data.text, 'dance')",
        "lookup(event.data.text, 'faq') != null",
        "after(event.data.text, 'i am') != ''",
        "size(words(event.data.text)) > 2",
        "event.data.text in ['x', 'y']",
        "event.data.text != 'x' && context.on",
        "contains(lower(event.data.text), 'robot')",
        "event.data.text == ''",
    ],
)
def test_guards_are_tried_both_ways(guard: str) -> None:
    states = {
        "a": {"on": {"heard": [{"guard": guard, "target": "b"}, "c"]}},
        "b": {"on": {"go": "a"}},
        "c": {"on": {"go": "a"}},
    }
    more = {
        "context": {"on": True},
        "phrases": {"dance": {"en": ["dance"]}},
        "answers": {"faq": [{"phrases": {"en": ["how tall"]}, "value": "57 cm"}]},
    }
    assert walked(states, **more).never_taken == ()


@for_each(
    ("schema", "guard"),
    [
        ({"type": "integer"}, "event.data.n > 20"),
        ({"type": "number"}, "event.data.n <= 0.5"),
        ({"type": "boolean"}, "event.data.n"),
        ({"enum": ["left", "right"]}, "event.data.n == 'right'"),
        ({"type": ["string", "null"]}, "event.data.n == null"),
        ({}, "event.data.n == 7"),
    ],
)
def test_fields_of_every_type_are_tried(schema: dict[str, Any], guard: str) -> None:
    events = {"go": {"type": "object", "properties": {"n": schema}, "required": ["n"]}}
    states = {
        "a": {"on": {"go": [{"guard": guard, "target": "b"}, "c"]}},
        "b": {"on": {"go": "a"}},
        "c": {"on": {"go": "a"}},
    }
    assert walked(states, events=events).never_taken == ()


def test_what_the_bound_leaves_out_is_said_and_nothing_concluded_from_it() -> None:
    states = {f"s{i}": {"on": {"go": f"s{i + 1}"}} for i in range(50)} | {"s50": {"on": {"go": "s0"}}}
    exploration = walked(states, bound=10)
    assert (exploration.configurations, exploration.waiting, exploration.complete) == (10, 1, False)
    assert found(exploration) == []


def test_no_rest_is_found() -> None:
    states = {"a": {"on": {"go": "b"}}, "b": {"always": "c"}, "c": {"always": "b"}}
    assert found(walked(states)) == [("restless", "a", 1)]


@pytest.mark.slow
def test_the_story_of_no_rest_ends_there(story: Callable[..., Path], capsys: pytest.CaptureFixture[str]) -> None:
    folder = story("  - wait: 1s\n")
    assert main(["test", str(folder), "--explore", "--behavior", "door"]) == 1
    told = capsys.readouterr().out
    assert "behaviors/door.yaml:14:20: no rest: `door` never comes to rest" in told
    lines = told.partition("    # yaml-language-server")[2].split("\n\n")[0].splitlines()
    assert lines[-1].strip() == "- event: spin"
    pasted = "\n".join(line[4:] for line in lines[1:])
    (folder / "behaviors" / "stories" / "found.yaml").write_text(pasted + "\n", "utf-8")
    assert main(["test", str(folder), "found"]) == 1
    assert "`door` never comes to rest" in capsys.readouterr().out


@pytest.mark.parametrize("guard", ["size(context.s) > 5", "size(context.l) >= 6"])
def test_what_grows_is_told_apart_by_its_length(guard: str) -> None:
    grow = {"assign": {"s": "context.s + 'a'", "l": "context.l + [1]"}}
    states = {"a": {"on": {"go": [{"guard": guard, "target": "b"}, {"actions": grow}]}}, "b": {"on": {"back": "a"}}}
    exploration = walked(states, context={"s": "", "l": []})
    assert found(exploration) == []
    assert exploration.never_taken == ()


@for_each(
    ("guard", "text"),
    [
        ("heard(event.data.text, 'titles')", "Golden Boy"),
        ("heard(event.data.text, context.titles)", "Golden Boy"),
        ("heard(event.data.text, context.round.entry.right)", "nineteen"),
        ("heard(event.data.text, context.round.entry.right)", "sembilan belas"),
        ("lookup(event.data.text, 'songs') != null", "the golden song"),
        ("after(event.data.text, 'play') == 'Ani'", "play Ani"),
        ("contains(event.data.text, 'golden')", "golden"),
    ],
)
def test_a_text_is_tried_that_the_guard_names(guard: str, text: str) -> None:
    machine = Machine.from_dict(
        {
            "initial": "a",
            "states": {"a": {}},
            "phrases": {"titles": {"en": ["Golden Boy"]}},
            "answers": {"songs": [{"phrases": ["the golden song"], "value": 1}]},
        }
    )
    right = {"en": ["nineteen", "one more"], "id": ["sembilan belas"]}
    context = {"titles": ["Golden Boy"], "round": {"entry": {"right": right}}}
    assert {"text": text} in list(samples(machine, SAID, [parse_expression(guard)], context))


@for_each(
    ("guard", "context"),
    [
        ("event.data.text == context.answer", {"answer": "Paris"}),
        ("context.answer == event.data.text && context.asked", {"answer": "Paris", "asked": True}),
        ("contains(event.data.text, context.answer) || event.data.text == context.answer", {"answer": "Paris"}),
        ("heard(event.data.text, context.titles)", {"titles": ["Golden Boy"]}),
        ("heard(event.data.text, context.titles) && size(event.data.text) > 3", {"titles": {"en": ["Golden Boy"]}}),
        ("size(words(event.data.text)) == context.length", {"length": 2}),
        ("event.data.text != context.answer", {"answer": "Ani"}),
    ],
)
def test_what_an_event_says_is_compared_with_the_context(guard: str, context: dict[str, Any]) -> None:
    states = {"a": {"on": {"go": "b"}}, "b": {"on": {"heard": {"guard": guard, "target": "a"}}}}
    assert found(walked(states, context=context)) == []


def test_what_is_compared_with_the_context_is_found_anew_when_it_changes() -> None:
    asks = {"guard": "context.answer == ''", "target": "b", "actions": {"assign": {"answer": "'Paris'"}}}
    again = {"target": "b", "actions": {"assign": {"answer": "'Rome'"}}}
    right = {"guard": "event.data.text == context.answer && context.answer == 'Rome'", "target": "c"}
    wrong = {"guard": "event.data.text == context.answer", "target": "a"}
    states = {"a": {"on": {"go": [asks, again]}}, "b": {"on": {"heard": [right, wrong]}}, "c": {"on": {"back": "a"}}}
    exploration = walked(states, context={"answer": ""})
    assert found(exploration) == []
    assert exploration.never_entered == ()


def test_no_text_is_tried_of_a_table_without_phrases() -> None:
    for context in ({}, {"titles": None}, {"titles": 3}, {"titles": {"en": 3}}):
        assert phrases_at(("context", "titles"), context) == []
    assert phrases_at(None, {"titles": ["Golden Boy"]}) == []


def test_of_too_many_combinations_each_value_is_tried_once() -> None:
    machine = Machine.from_dict({"initial": "a", "states": {"a": {}}})
    fields = "abcdefg"
    trees = [parse_expression(f"event.data.{field} == 'x{field}'") for field in fields]
    schema = {"properties": {field: {"type": "string"} for field in fields}, "required": [*fields]}
    tried = list(samples(machine, schema, trees, {}))
    assert len(tried) == 3 * len(fields) < 3 ** len(fields)
    for field in fields:
        assert {data[field] for data in tried} == {"Ani", "", f"x{field}"}


def test_what_is_invoked_is_walked_too() -> None:
    child = {
        "initial": "x",
        "states": {"x": {"do": {"say": "1 or 2?"}, "on": {"heard": "over"}}, "over": {"type": "final"}},
    }
    outer = {
        "initial": "a",
        "states": {"a": {"on": {"go": "b"}}, "b": {"invoke": {"behavior": "quiz", "onDone": "stuck"}}, "stuck": {}},
    }
    exploration = explore(Machine.from_dict(outer, behaviors={"quiz": child}), GO)
    assert ("dead-end", "stuck", 3) in found(exploration) or ("dead-end", "stuck", 2) in found(exploration)


def test_the_story_of_a_finding_can_be_pasted_and_leads_there(
    story: Callable[..., Path], capsys: pytest.CaptureFixture[str]
) -> None:
    folder = story("  - wait: 1s\n")
    door = folder / "behaviors" / "door.yaml"
    door.write_text(
        door.read_text("utf-8").replace("      spin: spinning\n", "").replace("20s: closed", "20s: #spun"), "utf-8"
    )
    text = door.read_text("utf-8").replace("20s: #spun", "20s: spinning").partition("  spinning:")[0]
    door.write_text(text.replace(", spin: null", "") + "  spinning: {}\n", "utf-8")
    assert main(["test", str(folder), "--explore", "--behavior", "door"]) == 1
    told = capsys.readouterr().out
    assert "a dead end: no transition leads out of `spinning`" in told
    lines = told.partition("    # yaml-language-server")[2].split("\n\n")[0].splitlines()
    pasted = "# yaml-language-server" + "\n".join([lines[0], *(line[4:] for line in lines[1:])])
    (folder / "behaviors" / "stories" / "found.yaml").write_text(pasted + "\n", "utf-8")
    assert main(["test", str(folder), "found"]) == 0
