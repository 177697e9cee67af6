"""Why a row of `hears` was taken, and why the others were not: in `why`, `why-not`, the outlook, and the log."""

from typing import Any

import pytest

from lumen.expressions import Scope, names
from lumen.insight.explaining.answers import why, why_not
from lumen.insight.explaining.changes import StepSituation
from lumen.insight.explaining.hearing import HeardRow, heard_rows
from lumen.insight.explaining.outlook import ways_out
from lumen.insight.explaining.pressing import refusal_of
from lumen.insight.exploration.expression_uses import of_transition
from lumen.language.buttons import Button
from lumen.language.events import Event
from lumen.run.ignoring import IgnoredEvents
from lumen.statechart import Machine, initial, step
from lumen.talk.sample_sentences import of_phrase, of_row
from tests.explaining.test_chains import Play
from tests.tables import for_each

PHRASES = {
    "dance": {"en": ["dance", "(show|do) me [your] dance"], "id": ["menari"]},
    "sing": {"en": ["sing"]},
    "refusal": {"en": ["no."]},
    "named": {"en": ["my name is {name}"]},
    "about": {"en": ["tell me about {exhibits}"]},
    "numbered": {"en": ["exhibit {number:n}"]},
    "anything": {"en": ["{text}"]},
    "fillers": {"en": ["please", "well"], "id": []},
    "negations": {"en": ["no", "dont", "do not"], "id": ["jangan"]},
    "questions": {"en": ["who", "why"], "id": ["mengapa"]},
}
"""Word lists of these tests, independent of those that come with Lumen."""
LISTS: dict[str, list[Any]] = {
    "exhibits": [{"id": "rex", "phrases": {"en": ["the rex", "rex"]}}, {"id": "organ", "phrases": {"en": ["organ"]}}]
}
ANSWERS = {"faq": [{"phrases": {"en": ["how tall"]}, "value": {"en": "57 cm"}}]}
ROWS: dict[str, Any] = {
    "dance": {"target": "dance", "guard": "context.n < 3"},
    "not dance": "sorry",
    "asked dance": "asked",
    "sing|refusal": "sing",
    "named": {"target": "named", "actions": {"assign": {"who": "heard.name"}}},
    "faq": "answered",
    "else": "lost",
}
TARGETS = ("dance", "sorry", "asked", "sing", "named", "met", "answered", "lost", "out")


def chart(hears: dict[str, Any] = ROWS, **keys: Any) -> dict[str, Any]:
    return {
        "id": "m",
        "context": {"n": 0, "who": ""},
        "phrases": PHRASES,
        "lists": LISTS,
        "answers": ANSWERS,
        "states": {"offer": {"hears": hears, **keys}, **{name: {} for name in TARGETS}},
    }


def rows(machine: Machine, text: str, **context: Any) -> dict[str, HeardRow]:
    scope = Scope({**machine.context, **context}, {"name": "heard", "data": {"result": text}}, language="en")
    full = scope._replace(phrases=machine.phrases, answers=machine.answers, lists=machine.lists, machine=machine)
    return {row.row.key: row for row in heard_rows(machine, "offer", full)}


@for_each(
    ("text", "fates"),
    [
        ("Dance, please.", {"dance": "taken", "not dance": "not negated", "asked dance": "no question"}),
        ("Please don't dance", {"dance": "negated", "not dance": "taken", "else": "better row"}),
        ("Why do you dance?", {"dance": "question", "asked dance": "taken", "sing|refusal": "not found"}),
        ("No.", {"sing|refusal": "taken", "else": "better row"}),
        ("There is no lift", {"sing|refusal": "part", "else": "taken"}),
        ("My name is Budi, dance", {"named": "taken", "dance": "better row"}),
        ("", {"dance": "not found", "else": "taken"}),
    ],
)
def test_what_becomes_of_each_row(text: str, fates: dict[str, str]) -> None:
    found = rows(Machine.from_dict(chart()), text)
    assert {key: found[key].fate for key in fates} == fates


@for_each(
    ("key", "text", "why", "strength", "caught"),
    [
        ("dance", "Dance, please.", "“Dance” in “Dance, please.”", 1, {"heard.phrase": "Dance"}),
        ("dance", "do me your dance", "“do me your dance” in “do me your dance”", 4, {
            "heard.phrase": "do me your dance",
        }),
        ("dance", "Well. Please don't dance!", "“dance” is negated in “Please don't dance”", 1, {}),
        ("not dance", "dance", "“dance” is not negated in “dance”", 1, {}),
        ("dance", "Why do you dance?", "“dance” is part of the question “Why do you dance”", 1, {}),
        ("asked dance", "dance", "“dance” is not part of a question in “dance”", 1, {}),
        (
            "sing|refusal",
            "there is no lift",
            "“no” counts only as a whole clause, but is part of “there is no lift”",
            1,
            {},
        ),
        ("sing|refusal", "well", "none of its phrases occurs in “well”", 0, {}),
        ("named", "my name is Ani", "“my name is Ani” in “my name is Ani”", 3, {
            "heard.phrase": "my name is Ani", "heard.name": "Ani",
        }),
        ("dance", "my name is Ani, dance", "hears named goes first", 1, {"heard.phrase": "dance"}),
        ("faq", "how tall", "“how tall” in “how tall”", 2, {"heard.phrase": "how tall", "heard.answer": "57 cm"}),
        ("else", "hm", "", 0, {}),
        ("else", "dance", "hears dance goes first", 0, {}),
    ],
)  # fmt: skip
def test_a_row_says_what_was_found_and_why_it_does_not_count(
    key: str, text: str, why: str, strength: int, caught: dict[str, Any]
) -> None:
    row = rows(Machine.from_dict(chart()), text)[key]
    assert (row.why, row.strength, dict(row.caught)) == (why, strength, caught)


def test_a_row_with_a_false_guard_lets_the_next_one_go() -> None:
    found = rows(Machine.from_dict(chart({**ROWS, "dance|sing": "sing"})), "dance", n=5)
    assert found["dance"].fate == "guard"
    assert found["dance"].why == "“dance” is in “dance”, but its guard is false"
    assert found["dance|sing"].fate == "taken"


@for_each(
    ("text", "link", "values"),
    [
        ("Dance, please.", "offer → dance, hears dance, as context.n < 3: “Dance” in “Dance, please.”", {
            "heard.phrase": "Dance", "context.n": 0,
        }),
        ("My name is Ani", "offer → named, hears named: “My name is Ani” in “My name is Ani”", {
            "heard.phrase": "My name is Ani", "heard.name": "Ani",
        }),
        ("hm", "offer → lost, hears else", {}),
    ],
)  # fmt: skip
def test_why_names_the_row_and_the_words(text: str, link: str, values: dict[str, Any]) -> None:
    play = Play(chart())
    play.happen("heard", {"result": text})
    (entered,) = {"dance", "named", "lost"} & play.now.configuration
    first, event = why(play.steps, entered).links[:2]
    assert (first.text, dict(first.values)) == (link, values)
    assert event.text == f'heard {{"result": "{text}"}}'


def refused(play: Play, state: str) -> dict[str, Any]:
    (reason,) = why_not(play.steps, state).reasons
    return {**reason.to_json(), "proved": _leads(play, reason.change, reason.number, state)}


def _leads(play: Play, change: Any, number: int, state: str) -> bool | None:
    """Return whether the proposed change leads to the state; None if there is no proposal."""
    if change is None:
        return None
    one = play.steps[number]
    assert one.before
    decided = one.step.event if "event" not in change else None
    situation = StepSituation(one.before if decided else one.step.snapshot, decided).edited(change)
    assert situation.event
    return state in step(play.machine, situation.snapshot, situation.event).entered


@for_each(
    ("text", "state", "because", "said", "change"),
    [
        ("Please don't dance", "dance", "unheard",
         "offer → dance, hears dance, as context.n < 3; heard came, but “dance” is negated in “Please don't dance”",
         {"event.data.result": "dance"}),
        ("Dance", "sorry", "unheard",
         "offer → sorry, hears not dance; heard came, but “Dance” is not negated in “Dance”",
         {"event.data.result": "no dance"}),
        ("Dance", "asked", "unheard",
         "offer → asked, hears asked dance; heard came, but “Dance” is not part of a question in “Dance”",
         {"event.data.result": "who dance"}),
        ("Sing for me", "answered", "unheard",
         "offer → answered, hears faq; heard came, but none of its phrases occurs in “Sing for me”",
         {"event.data.result": "how tall"}),
        ("My name is Ani. Dance", "dance", "preempted",
         "offer → dance, hears dance, as context.n < 3; heard came, offer → named, hears named was taken instead",
         {"event.data.result": "dance"}),
        ("Dance", "lost", "preempted",
         "offer → lost, hears else; heard came, offer → dance, hears dance, as context.n < 3 was taken instead",
         {"event.data.result": "lorem ipsum dolor sit amet"}),
    ],
)  # fmt: skip
def test_why_not_names_the_rule_that_dropped_the_row(
    text: str, state: str, because: str, said: str, change: dict[str, Any]
) -> None:
    play = Play(chart())
    play.happen("heard", {"result": text})
    reason = refused(play, state)
    assert (reason["because"], reason["text"], reason["change"], reason["proved"]) == (because, said, change, True)


def test_why_not_of_a_false_guard_proposes_what_makes_it_true() -> None:
    play = Play(chart() | {"context": {"n": 5, "who": ""}})
    play.happen("heard", {"result": "dance"})
    reason = refused(play, "dance")
    assert reason["text"].endswith("heard came, but context.n < 3 was false")
    assert reason["false"] == {"text": "context.n < 3", "values": {"context.n": 5}}
    assert reason["change"] == {"context.n": 2}
    assert reason["proved"]


@for_each(
    ("name", "guard", "said", "values", "change"),
    [
        ("named", "heard.name == 'Ani'", "my name is Budi", {"heard.name": "Budi"}, "my name is Ani"),
        ("numbered", "heard.n >= 12", "exhibit 3", {"heard.n": 3}, "exhibit 12"),
        (
            "about",
            "heard.exhibits.id == 'organ'",
            "tell me about rex",
            {"heard.exhibits.id": "rex"},
            "tell me about organ",
        ),
    ],
)
def test_why_not_proposes_what_a_guard_wants_to_be_caught(
    name: str, guard: str, said: str, values: dict[str, Any], change: str
) -> None:
    play = Play(chart({name: {"target": "met", "guard": guard}}))
    play.happen("heard", {"result": said})
    reason = refused(play, "met")
    assert reason["false"] == {"text": guard, "values": values}
    assert (reason["change"], reason["proved"]) == ({"event.data.result": change}, True)


def test_a_guard_on_what_was_caught_depends_on_what_is_said() -> None:
    play = Play(chart({"named": {"target": "met", "guard": "size(heard.name) > 900"}}))
    play.happen("heard", {"result": "my name is Budi"})
    assert refused(play, "met")["note"] == ("no other value of heard.name was found that would have selected it")


def test_why_not_of_a_sentence_that_was_never_said_proposes_one() -> None:
    play = Play(chart())
    play.happen("touched")
    reason = refused(play, "named")
    assert (reason["because"], reason["change"]) == (
        "no-event",
        {"event": "heard", "event.data.result": "my name is Budi"},
    )
    assert reason["proved"]


REGIONS: dict[str, Any] = {
    "id": "m",
    "phrases": PHRASES,
    "type": "parallel",
    "states": {
        "one": {"states": {"a": {"hears": {"dance": "b", "else": "lost"}}, "b": {}, "lost": {}}},
        "two": {"states": {"c": {"hears": {"sing": "d", "anything": "caught"}}, "d": {}, "caught": {}}},
    },
}


@for_each(
    ("text", "state", "said"),
    [
        ("sing", "one.lost", "one.a → one.lost, hears else; heard came, two.c → two.d, hears sing"),
        ("dance", "two.caught", "two.c → two.caught, hears anything; heard came, one.a → one.b, hears dance"),
    ],
)
def test_a_late_row_names_the_row_of_another_state(text: str, state: str, said: str) -> None:
    play = Play(REGIONS)
    play.happen("heard", {"result": text})
    reason = refused(play, state)
    assert (reason["because"], reason["text"]) == ("preempted", f"{said} was taken instead")


def test_an_invoked_behaviour_that_listens_keeps_else_from_going() -> None:
    quiz = {"phrases": PHRASES, "states": {"ask": {"hears": {"sing": "sung"}}, "sung": {}}}
    host = {"states": {"playing": {"invoke": {"behavior": "quiz"}, "hears": {"else": "lost"}}, "lost": {}}}
    play = Play(host, quiz=quiz)
    play.happen("heard", {"result": "hm"})
    assert refused(play, "lost")["text"] == (
        "playing → lost, hears else; heard came, a behaviour that this state invokes listens too"
    )
    line = IgnoredEvents().line(play.machine, play.steps[-1].step)
    else_too = "hears else is false in playing (a behaviour that this state invokes listens too)"
    assert line == f"“hm” while no row of quiz/ask matches, and {else_too}"


@for_each(
    ("hears", "context", "text", "line"),
    [
        ({"sing": "sing"}, {}, "hm", "“hm” while no row of offer matches"),
        ({"sing": "sing"}, {}, "sing", ""),
        ({"dance": "dance", "sing": "sing"}, {}, "don't dance",
         "“don't dance” while hears dance is false in offer (“dance” is negated in “don't dance”)"),
        ({"dance": {"target": "dance", "guard": "context.n < 3"}}, {"n": 5}, "dance",
         "“dance” while context.n < 3 is false in offer (context.n is 5)"),
        ({"dance": {"target": "dance", "guard": "context.n < 3"}}, {"n": 0}, "hm",
         "“hm” while no row of offer matches"),
        ({"named": {"target": "named", "guard": "heard.name == 'Ani'"}}, {}, "my name is Budi",
         "“my name is Budi” while heard.name == 'Ani' is false in offer (heard.name is 'Budi')"),
        ({"else": {"target": "lost", "guard": "context.n > 0"}}, {}, "hm",
         "“hm” while context.n > 0 is false in offer (context.n is 0)"),
    ],
)  # fmt: skip
def test_the_log_tells_of_a_sentence_that_changed_nothing(
    hears: dict[str, Any], context: dict[str, Any], text: str, line: str
) -> None:
    machine = Machine.from_dict(chart(hears) | {"context": {"n": 0, "who": "", **context}})
    taken = step(machine, initial(machine).snapshot, Event("heard", {"result": text}, 10.0))
    assert IgnoredEvents().line(machine, taken) == line


@for_each(
    ("hears", "keys", "ways"),
    [
        (
            {"dance": {"target": "dance", "guard": "context.n > 3"}, "sing": "sing", "else": "lost"},
            {},
            ["hears dance closed: context.n > 3 is false: context.n is 0", "hears sing open: when it hears sing",
             "hears else open: when it hears else"],
        ),
        (
            {"named": {"target": "named", "guard": "context.n == 0 && heard.name != ''"}},
            {},
            ["hears named open: when it hears named and context.n == 0 && heard.name != ''"],
        ),
        (
            {"sing": "sing", "else": "lost"},
            {"on": {"heard": "out"}},
            ["on heard open: when heard comes", "hears sing closed: offer → out, on heard goes first",
             "hears else closed: offer → out, on heard goes first"],
        ),
        (
            {"sing": "sing", "else": "lost"},
            {"on": {"*": "out"}},
            ["hears sing open: when it hears sing", "on * open: when anything comes",
             "hears else closed: offer → out, on * goes first"],
        ),
    ],
)  # fmt: skip
def test_the_outlook_calls_no_row_sure(hears: dict[str, Any], keys: dict[str, Any], ways: list[str]) -> None:
    """Only the sentence decides whether a row fires, so such a row blocks no other; an earlier row may."""
    machine = Machine.from_dict(chart(hears, **keys))
    now = initial(machine).snapshot
    found = [
        f"{way.transition.hears.title if way.transition.hears else f'on {way.transition.event}'} "
        f"{'open' if way.open else 'closed'}: {way.why}"
        for way in ways_out(machine, now, now.at)
    ]
    assert found == ways


def test_an_outer_else_waits_for_the_inner_one() -> None:
    states = {
        "a": {"hears": {"else": "b"}, "states": {"in": {"hears": {"dance": "out", "else": "out"}}, "out": {}}},
        "b": {},
    }
    machine = Machine.from_dict({"id": "m", "phrases": PHRASES, "states": states})
    now = initial(machine).snapshot
    outer = next(way for way in ways_out(machine, now, now.at) if way.transition.source == "a")
    assert (outer.open, outer.why) == (False, "a.in → a.out, hears else goes first")


def test_a_button_that_says_something_is_told_why_nobody_hears_it() -> None:
    machine = Machine.from_dict(chart({"dance": "dance"}))
    now = initial(machine).snapshot
    button = Button({"": "Stop"}, "heard", {"result": "don't dance"})
    assert refusal_of(machine, now, button, 1.0) == "“dance” is negated in “don't dance”"


@for_each(
    ("phrase", "sentences"),
    [
        ("dance", [("dance", {})]),
        ("I'm {name}.", [("I'm Budi", {"name": "Budi"})]),
        ("(show|take) me [to] {exhibits}", [
            ("show me the rex", "rex"), ("show me to the rex", "rex"), ("take me the rex", "rex"),
            ("take me to the rex", "rex"),
        ]),
        ("exhibit {number:n}", [("exhibit 3", {"n": 3})]),
        ("about {nothing}", []),
        ("a (b", [("a (b", {})]),
    ],
)  # fmt: skip
def test_a_phrase_has_a_sentence_for_each_form(phrase: str, sentences: list[tuple[str, Any]]) -> None:
    found = [(text, dict(caught)) for text, caught in of_phrase(phrase, LISTS)]
    rex = LISTS["exhibits"][0]
    assert found == [(text, {"exhibits": rex} if caught == "rex" else caught) for text, caught in sentences]


@pytest.mark.parametrize("key", ["dance", "not dance", "asked dance", "sing|refusal", "named", "faq", "else"])
def test_the_sentences_of_a_row_take_it(key: str) -> None:
    machine = Machine.from_dict(chart())
    row = next(t.hears for t in machine.states["offer"].transitions if t.hears and t.hears.key == key)
    sentences = list(of_row(machine, row, machine.context))
    assert len(sentences) >= 2 or key in ("faq", "named")
    for sentence in sentences:
        assert rows(machine, sentence)[key].fate == "taken", sentence


QUIZ: dict[str, Any] = {
    "id": "m",
    "lists": {"questions": [{"ask": "How many legs?", "right": {"en": ["four"]}}]},
    "states": {
        "quiz": {
            "for": {"each": "lists.questions", "as": "question"},
            "states": {
                "ask": {"hears": {"question.right": "praise", "else": "wrong"}},
                "praise": {},
                "wrong": {},
                "over": {"type": "final"},
            },
        }
    },
}


def test_phrases_of_a_lists_entry_are_found_and_proposed() -> None:
    play = Play(QUIZ)
    play.happen("heard", {"result": "three"})
    reason = refused(play, "quiz.praise")
    assert reason["text"] == (
        "quiz.ask → quiz.praise, hears question.right; heard came, but none of its phrases occurs in “three”"
    )
    assert (reason["change"], reason["proved"]) == ({"event.data.result": "four"}, True)


def test_what_was_heard_rests_on_the_entry_that_it_was_compared_with() -> None:
    play = Play(QUIZ)
    play.happen("touched")
    play.happen("heard", {"result": "Four!"})
    answer = why(play.steps, "quiz.praise")
    assert answer.links[0].text == "quiz.ask → quiz.praise, hears question.right: “Four” in “Four!”"
    key = next(key for key in play.machine.context if key.startswith("question_in"))
    ask = play.machine.states["quiz.ask"]
    assert {key} <= {name for t in ask.transitions for use in of_transition(t) for name in names(use.tree).context}
