"""Rows of `hears` in words: in diagrams, in coverage, in the log of a step, and in the differences between versions."""

from typing import Any

from lumen.features.console.day import understood
from lumen.insight.changes.machines import machine_changes
from lumen.insight.explaining.words import of_transition
from lumen.insight.replay.entries import JournalInput
from lumen.insight.replay.replaying import ReplayedStep
from lumen.language.events import Event
from lumen.run.captions import caption
from lumen.run.coverage import described
from lumen.run.diagrams.transition_rows import rows_of
from lumen.run.entry_causes import why
from lumen.statechart import Machine, initial, step
from tests.tables import for_each

PHRASES = {"dance": {"en": ["dance"]}, "sing": {"en": ["sing"]}, "my_name": {"en": ["my name is {name}"]}}


def machine(hears: dict[str, Any], **phrases: Any) -> Machine:
    states = {"offer": {"hears": hears}, "dance": {}, "sing": {}}
    return Machine.from_dict(
        {"id": "m", "context": {"n": 0, "visitor": ""}, "phrases": PHRASES | phrases, "states": states}
    )


GUARDED = {"target": "dance", "guard": "context.n > 3"}
NAMED = {"target": "dance", "guard": "heard.name != 'Budi'", "actions": {"assign": {"visitor": "heard.name"}}}


@for_each(
    ("key", "row", "shown", "drawn", "covered", "told"),
    [
        ("dance", "dance", "hears dance", "hears dance → dance", "on `hears dance`", "→ dance, hears dance"),
        (
            "not dance  | sing",
            ".",
            "hears not dance|sing",
            "hears not dance|sing → again",
            "on `hears not dance|sing`",
            "→ offer, hears not dance|sing",
        ),
        (
            "asked sing",
            GUARDED,
            "hears asked sing [context.n > 3]",
            "hears asked sing if context.n > 3 → dance",
            "on `hears asked sing`, as context.n > 3",
            "→ dance, hears asked sing, as context.n > 3",
        ),
        (
            "my_name",
            NAMED,
            "hears my_name [heard.name != 'Budi']",
            "hears my_name if heard.name != 'Budi' → dance",
            "on `hears my_name`, as heard.name != 'Budi'",
            "→ dance, hears my_name, as heard.name != 'Budi'",
        ),
        ("else", "sing", "hears else", "hears else → sing", "on `hears else`", "→ sing, hears else"),
    ],
)
def test_a_row_is_named_by_its_key(key: str, row: Any, shown: str, drawn: str, covered: str, told: str) -> None:
    chart = machine({key: row})
    (transition,) = chart.states["offer"].transitions
    assert caption(transition) == shown
    assert list(rows_of(chart, chart.states["offer"])) == [drawn]
    assert described(chart, transition).startswith(f"`offer` {covered}, to `")
    assert of_transition(chart, transition) == f"offer {told}"


def test_what_is_left_of_a_row_with_a_guard_is_drawn_as_such() -> None:
    chart = machine({"dance": [GUARDED, "sing"], "sing": "sing"})
    assert list(rows_of(chart, chart.states["offer"])) == [
        "hears dance if context.n > 3 → dance",
        "otherwise hears dance, hears sing → sing",
    ]


def test_a_transcript_names_the_row_that_was_taken() -> None:
    chart = machine({"my_name": NAMED, "else": "sing"})
    begun = initial(chart).snapshot
    assert why(step(chart, begun, Event("heard", {"result": "My name is Ani"}))) == (
        "hears my_name, as heard.name != 'Budi'"
    )
    assert why(step(chart, begun, Event("heard", {"result": "well"}))) == "hears else"


@for_each(("text", "is_understood"), [("please dance", True), ("please don't dance", True), ("well", False)])
def test_what_only_else_took_was_not_understood(text: str, is_understood: bool) -> None:
    chart = machine({"dance": "dance", "not dance": ".", "else": "sing"})
    begun, event = initial(chart).snapshot, Event("heard", {"result": text})
    entry = JournalInput(1, "heard", event)
    assert understood(entry, ReplayedStep(entry, chart, begun, step(chart, begun, event))) == is_understood


@for_each(
    ("before", "after", "told"),
    [
        ({"sing": "sing"}, {"sing": "sing"}, []),
        ({"my_name": NAMED}, {"dance": "dance", "my_name": NAMED}, ["now goes to `dance` on `hears dance`"]),
        ({"dance": "dance", "my_name": NAMED}, {"my_name": NAMED}, ["no longer goes to `dance` on `hears dance`"]),
        ({"dance": "dance"}, {"dance": "sing"}, ["now goes to `sing` on `hears dance`, not `dance`"]),
        ({"dance": "dance"}, {"not dance": "sing"}, [
            "no longer goes to `dance` on `hears dance`", "now goes to `sing` on `hears not dance`",
        ]),
        ({"dance": "dance"}, {"dance|sing": "dance"}, ["hears `dance|sing`, not `dance`"]),
        ({"my_name": NAMED}, {"asked my_name": NAMED}, ["hears `asked my_name`, not `my_name`"]),
        ({"dance": "dance"}, {"dance": GUARDED}, ["now goes to `dance` on `hears dance` if `context.n > 3`"]),
        ({"my_name": NAMED}, {"my_name": {**NAMED, "guard": "heard.name != ''"}}, [
            "now goes to `dance` on `hears my_name` if `heard.name != ''`"
        ]),
        ({"my_name": NAMED}, {"my_name": {**NAMED, "actions": {"assign": {"visitor": "heard.text"}}}}, [
            "now sets `visitor` on `hears my_name`"
        ]),
        ({"dance": "dance", "sing": "sing"}, {"sing": "sing", "dance": "dance"}, [
            "tries its rows of `hears` in a different order"
        ]),
    ],
)  # fmt: skip
def test_what_differs_is_told_row_by_row(before: dict[str, Any], after: dict[str, Any], told: list[str]) -> None:
    """Changes ignore the number of a row, since it depends on the rows above it."""
    found = [change.sentence for change in machine_changes("m", machine(before), machine(after))]
    assert found == [f"state `offer` {sentence}" for sentence in told]


def test_phrases_that_changed_are_told() -> None:
    other = machine({"dance": "dance"}, dance={"en": ["dance", "dancing"]}, sing={"en": ["sing"], "anyhow": True})
    assert [change.sentence for change in machine_changes("m", machine({"dance": "dance"}), other)] == [
        "phrases `dance` changed",
        "phrases `sing` now count even if they are negated",
    ]
