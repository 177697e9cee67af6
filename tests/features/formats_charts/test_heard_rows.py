"""Rows of `hears` in other tools' charts: their equivalents, the reports, and the round trip."""

import json
from typing import Any

import pytest

from lumen.features.formats_charts.scxml import read_scxml, write_scxml
from lumen.features.formats_charts.xstate import read_xstate, write_xstate
from lumen.language.diagnostics import has_errors
from lumen.language.events import Event
from lumen.project.formats.conversion_findings import dotted
from lumen.project.formats.yaml_document import document_yaml
from lumen.project.yaml_reader import parse
from lumen.statechart import Machine, initial, step
from tests.tables import for_each

CHART: dict[str, Any] = {
    "id": "tour",
    "context": {"n": 0, "who": ""},
    "phrases": {
        "dance": {"en": ["dance", "dancing"]},
        "sing": {"en": ["sing"]},
        "named": {"en": ["my name is {name}"]},
        "halt": {"en": ["stop"], "anyhow": True},
    },
    "answers": {"faq": [{"phrases": {"en": ["how tall"]}, "value": {"en": "57 cm"}}]},
    "initial": "offer",
    "states": {
        "offer": {
            "on": {"*": {"guard": "context.n > 5", "target": "lost"}, "touched": "lost"},
            "hears": {
                "dance": {"guard": "context.n < 3", "target": "dance"},
                "not dance|sing": "lost",
                "asked dance": [{"guard": "context.n > 3", "target": "lost"}, "dance"],
                "named": {
                    "guard": "heard.name != 'Ani'",
                    "target": "met",
                    "actions": [{"assign": {"who": "heard.name"}}, {"say": {"en": "Hello {{ heard.name }}"}}],
                },
                "halt": "offer",
                "faq": {"target": "lost", "actions": [{"assign": {"who": "heard.answer"}}]},
                "else": {"actions": [{"assign": {"n": "context.n + 1"}}]},
            },
        },
        "dance": {},
        "met": {},
        "lost": {},
    },
}
SAID = [
    "dance", "please don't dance", "why do you dance", "my name is Budi", "my name is Ani", "how tall are you", "hm",
    "don't stop",
]  # fmt: skip
WAYS: list[tuple[Any, Any]] = [(write_scxml, read_scxml), (write_xstate, read_xstate)]


def outcomes(machine: Machine) -> list[tuple[Any, ...]]:
    found = []
    for text in SAID:
        taken = step(machine, initial(machine).snapshot, Event("heard", {"result": text}))
        context = taken.snapshot.context
        found.append((text, sorted(taken.snapshot.configuration), context["n"], context["who"], taken.commands))
    return found


@pytest.mark.parametrize(("write", "read"), WAYS, ids=["scxml", "xstate"])
def test_rows_come_back_with_their_guards_and_actions(write: Any, read: Any) -> None:
    machine = Machine.from_dict(CHART)
    text, said = write(machine, dotted("tour"))
    assert not has_errors(said)
    data, found = read("tour", text.encode(), "tour")
    assert found == []
    assert data["states"] == {
        name: {**state, **({"on": data["states"]["offer"]["on"]} if "on" in state else {})}
        for name, state in CHART["states"].items()
    }
    assert data["phrases"]["halt"] == CHART["phrases"]["halt"]
    again = Machine.from_dict(data)
    assert outcomes(again) == outcomes(machine)
    assert read("tour", write(again, dotted("tour"))[0].encode(), "tour")[0] == data
    document, _ = parse("tour.yaml", document_yaml(data).encode())
    assert document
    assert document.data == data


@pytest.mark.parametrize(
    ("write", "word"),
    [(write_scxml, "condition `hears`"), (write_xstate, "guard `lumen.hears`")],
    ids=["scxml", "xstate"],
)
def test_each_row_is_reported_at_its_place(write: Any, word: str) -> None:
    said = write(Machine.from_dict(CHART), dotted("tour"))[1]
    rows = {str(d.place.file): (d.message, d.hint) for d in said if "`hears " in d.message}
    hint = "implement this guard in the other tool: the longest match, negation, questions and captured values"
    where = "tour (states.offer.hears.{})"
    assert rows == {
        where.format(place): (f"`hears {key}` becomes a {word}", hint)
        for place, key in [
            *((key, key) for key in CHART["states"]["offer"]["hears"] if key != "asked dance"),
            ("asked dance.0", "asked dance"),
            ("asked dance.1", "asked dance"),
        ]
    }


def test_scxml_has_conditions_in_the_order_in_which_rows_are_asked() -> None:
    text, _ = write_scxml(Machine.from_dict(CHART), dotted("tour"))
    dance = "hears(_event.data.result, 'dance') &amp;&amp; (n &lt; 3)"
    assert f'<transition event="heard" lumen:hears="dance" cond="{dance}" target="dance"' in text
    assert '<assign location="who" expr="_x.heard.name"/>' in text
    assert text.index('event="touched"') < text.index('lumen:hears="dance"') < text.index('event="*"')


def test_xstate_asks_for_a_guard_of_that_name() -> None:
    text, _ = write_xstate(Machine.from_dict(CHART), dotted("tour"))
    rows = json.loads(text)["states"]["offer"]["on"]["heard"]
    assert rows[0]["guard"] == {"type": "lumen.hears", "params": {"row": "dance", "source": "context.n < 3"}}
    assert rows[1]["guard"] == {"type": "lumen.hears", "params": {"row": "not dance|sing"}}


@for_each(
    ("old", "new", "lost"),
    [
        (
            'lumen:hears="dance" cond="hears(',
            'lumen:hears="dance" cond="listens(',
            "the condition of a row of `hears` must begin with `hears(_event.data.result, 'dance')`",
        ),
        ('event="heard" lumen:hears="dance"', 'event="noted" lumen:hears="dance"', "`hears()` has no counterpart"),
        (' lumen:hears="dance"', "", "`hears()` has no counterpart"),
    ],
)
def test_a_condition_that_another_tool_changed_is_reported(old: str, new: str, lost: str) -> None:
    text, _ = write_scxml(Machine.from_dict(CHART), dotted("tour"))
    assert old in text
    data, found = read_scxml("tour", text.replace(old, new, 1).encode(), "tour")
    assert lost in " ".join(d.message for d in found)
    assert has_errors(found)
    assert "dance" not in data["states"]["offer"]["hears"]


@for_each(
    ("change", "lost"),
    [
        ({"row": "singing"}, "the row `singing` of `hears` can't be read"),
        ({"row": "dance", "source": "heard.nothing ("}, "the row `dance` of `hears` can't be read"),
        ({"row": 3}, "the row `3` of `hears` can't be read"),
    ],
)
def test_a_guard_that_another_tool_changed_is_reported(change: dict[str, Any], lost: str) -> None:
    chart = json.loads(write_xstate(Machine.from_dict(CHART), dotted("tour"))[0])
    chart["states"]["offer"]["on"]["heard"][0]["guard"]["params"] = change
    data, found = read_xstate("tour", json.dumps(chart).encode(), "tour")
    assert [d.message for d in found] == [lost]
    assert has_errors(found)
    assert "dance" not in data["states"]["offer"]["hears"]


def test_a_row_waits_for_what_is_heard_only() -> None:
    chart = json.loads(write_xstate(Machine.from_dict(CHART), dotted("tour"))[0])
    on = chart["states"]["offer"]["on"]
    on["touched"] = on.pop("heard")[:1]
    data, found = read_xstate("tour", json.dumps(chart).encode(), "tour")
    assert [d.message for d in found] == ["the code of the guard `lumen.hears` is not in the file"]
    assert "hears" not in data["states"]["offer"]


QUIZ: dict[str, Any] = {
    "id": "quiz",
    "context": {"n": 1},
    "lists": {"questions": [{"right": {"en": ["four"]}}]},
    "states": {
        "round": {
            "for": {"each": "lists.questions", "as": "question"},
            "states": {
                "ask": {
                    "hears": {
                        "question.right": {"guard": "context.n == 1", "target": "praise"},
                        "not question.right": "ask",
                        "else": "wrong",
                    }
                },
                "praise": {},
                "wrong": {},
                "over": {"type": "final"},
            },
        }
    },
}


@pytest.mark.parametrize(("write", "read"), WAYS, ids=["scxml", "xstate"])
def test_phrases_of_a_lists_entry_become_a_guard(write: Any, read: Any) -> None:
    """A chart has no `for`, so no row could name its variable; what a guard can't say is left out and reported."""
    text, said = write(Machine.from_dict(QUIZ), dotted("quiz"))
    rows = [d for d in said if "`hears " in d.message]
    source = "(heard(event.data.result, context.question_in_round.entry.right)) && (context.n == 1)"
    assert [d.message for d in rows if has_errors([d])] == [
        next(d.message for d in rows if "`hears not question.right` is left out: " in d.message)
    ]
    assert f"`hears question.right` becomes the guard `{source}`" in [d.message for d in rows]
    if write is write_scxml:
        return  # which has no lists to go through: that is reported when it is read
    data, found = read("quiz", text.encode(), "quiz")
    assert not has_errors(found)
    again = Machine.from_dict(data)
    for text, state in (("Four!", "round.praise"), ("three", "round.wrong")):
        taken = step(again, initial(again).snapshot, Event("heard", {"result": text}))
        assert state in taken.snapshot.configuration
