"""A sentence in a state: the phrase that was found for each row, the row that is taken, and why the others are not."""

from typing import Any

from lumen.insight.explaining.sentences import explained, first_context
from lumen.language.events import Event
from lumen.language.machines import hearing_states, rows_around
from lumen.statechart import initial, step
from lumen.statechart.direct_entry import entered_directly
from tests.explaining.guide import guide
from tests.tables import for_each

MACHINE = guide()


def rows(path: str, text: str, context: dict[str, Any] | None = None) -> dict[str, str]:
    """Return the reason for each row's result, for the first row of each key."""
    found = explained(MACHINE, path, text, {**first_context(MACHINE), **(context or {})})
    why: dict[str, str] = {}
    for row in found.rows:
        why.setdefault(row.key, row.because(found.taken))
    return why


def test_each_row_has_its_reason() -> None:
    why = rows("offer.choice", "No, please don't dance!")
    assert why == {
        "dance": "negated",
        "sing": "not found",
        "not dance|sing": "taken",
        "asked dance": "negated",
        "tour_of": "not found",
        "faq": "not found",
        "no|done": why["no|done"],
        "else": "`not dance|sing` is taken before it",
    }
    assert rows("offer.choice", "why do you dance") | {"dance": "in a question", "asked dance": "taken"} == rows(
        "offer.choice", "why do you dance"
    )
    assert rows("offer.choice", "dance")["asked dance"] == "not in a question"
    assert rows("offer.choice", "dance")["not dance|sing"] == "not negated"
    assert rows("offer.choice", "no parking")["no|done"] == "not a whole clause"


def test_guards_decide_with_the_context() -> None:
    assert rows("offer.choice", "sing")["sing"] == "its guard is false"
    assert rows("offer.choice", "sing")["else"] == "taken"
    assert rows("offer.choice", "sing", {"tries": 3})["sing"] == "taken"
    failed = explained(MACHINE, "offer.choice", "how tall are you", MACHINE.context)
    (faq,) = [row for row in failed.rows if row.key == "faq"]
    assert faq.guard is False
    assert faq.because(failed.taken) == f"its guard fails: {faq.error}"
    assert faq.error
    later = explained(MACHINE, "ask_name", "what", {"tries": 2})
    assert later.taken
    assert later.taken.transition.targets == ("offer",)


def test_what_was_found_is_told_with_its_words() -> None:
    sentence = explained(MACHINE, "offer.choice", "Please show me the Organ, no", MACHINE.context, "en")
    found = {row.key: row.found for row in sentence.rows}
    assert found["tour_of"] == ("tour_of", "show me the Organ", 4, None, False, False, "")
    assert found["no|done"] == ("no", "no", 1, True, False, False, "")
    assert found["sing"] is None
    assert sentence.taken
    assert sentence.taken.slots == {"exhibits": MACHINE.lists["exhibits"][0]}
    number = explained(MACHINE, "offer.choice", "exhibit three", MACHINE.context).taken
    assert number
    assert number.slots == {"n": 3}


def test_what_waits_under_on_comes_before_rows_and_a_wildcard_after_them() -> None:
    sentence = explained(MACHINE, "offer.quiet", "dance", MACHINE.context)
    assert [row.key for row in sentence.rows[:3]] == ["on heard", "dance", "on *"]
    assert sentence.taken == sentence.rows[0]
    assert sentence.rows[1].because(sentence.taken) == "`on heard` is taken before it"


def test_an_entry_of_a_list_is_the_first_one() -> None:
    assert rows("quiz.ask", "wood") == {"exhibit.right": "taken", "else": "`exhibit.right` is taken before it"}
    assert rows("quiz.ask", "gold")["exhibit.right"] == "not found"
    (row, _) = explained(MACHINE, "quiz.ask", "it is wood", first_context(MACHINE)).rows
    assert row.found
    assert row.found.name == "exhibit.right"


def test_nothing_is_taken_where_nothing_is_heard() -> None:
    assert explained(MACHINE, "bye", "dance", MACHINE.context).rows == ()
    assert explained(MACHINE, "bye", "dance", MACHINE.context).taken is None
    assert [state.path for state in hearing_states(MACHINE)] == [
        "ask_name",
        "offer",
        "offer.choice",
        "offer.quiet",
        "quiz.ask",
    ]
    assert [row.key for row in rows_around(MACHINE, "offer.quiet")] == ["dance", "no|done", "else"]


@for_each(
    ("state", "text"),
    [
        (state, text)
        for state in ("ask_name", "choice", "offer.quiet")
        for text in (
            "", "dance", "don't dance", "why do you dance", "sing", "no", "no parking", "nothing, dance", "exhibit 3",
            "how tall are you", "I'm Budi", "show me the clock and dance", "no, show me the clock", "menari",
        )
    ],
)  # fmt: skip
def test_the_row_is_the_one_that_a_step_takes(state: str, text: str) -> None:
    begun = entered_directly(MACHINE, initial(MACHINE).snapshot, state, Event("go")).snapshot
    taken = step(MACHINE, begun, Event("heard", {"result": text})).transitions
    path = next(one.path for one in MACHINE.states.values() if one.name == state)
    row = explained(MACHINE, path, text, begun.context).taken
    assert ([row.transition] if row else []) == list(taken)
