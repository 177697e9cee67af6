"""Which row of `hears` a sentence takes: alone, refused, asked about, of several states, and at last `else`."""

import gc
from typing import Any

from lumen.language.events import Event
from lumen.statechart import Machine, initial, step
from lumen.talk.hearing import hearing_of
from tests.tables import for_each
from tests.talk.machines import caught, hearing, said, taken

PHRASES = {
    "dance": {"en": ["dance", "dancing"], "id": ["menari"], "de": ["tanz"]},
    "sing": {"en": ["sing", "song"]},
    "photo": {"en": ["(take|have) a photo", "photo"]},
    "no": {"en": ["no", "nope", "that is all", "do not want"], "id": ["tidak", "sudah"]},
    "fine": {"en": ["fine", "not bad"]},
    "bad": {"en": ["bad"]},
    "stop": {"anyhow": True, "en": ["stop"]},
    "me": {"en": ["my name is {name}", "I am {name?}", "{name?}."]},
    "exit": {"en": ["where is the exit"]},
}
OFFER = {
    "dance": "dances", "sing": "sings", "photo": "poses", "not dance|sing": "refused", "asked dance|sing": "asked_it",
    "stop": "stops", "no": "ends", "fine": "well", "bad": "unwell", "exit": "shows", "else": "answers",
}  # fmt: skip


@for_each(
    "text, state",
    [
        ("Dance, please.", "dances"),
        ("please don't sing", "refused"),
        ("I never sing", "refused"),
        ("don't sing, dance", "dances"),
        ("not sing but dance", "dances"),
        ("why do you dance?", "asked_it"),
        ("Siapa yang menari", "asked_it"),
        ("I have a question: why do you sing", "asked_it"),
        ("No.", "ends"),
        ("well, no, please", "ends"),
        ("well then no", "ends"),
        ("no no no", "ends"),
        ("no idea what you mean", "answers"),
        ("kamu sudah makan", "answers"),
        ("sudah dong", "ends"),
        ("That is all.", "ends"),
        ("that is all I know", "answers"),
        ("I do not want to dance", "refused"),
        ("I do not want", "ends"),
        ("not bad", "well"),
        ("bad", "unwell"),
        ("no, stop", "stops"),
        ("don't stop", "stops"),
        ("can't you dance", "dances"),
        ("why not dance", "dances"),
        ("tanz nicht", "refused"),
        ("sing me a song and take a photo", "poses"),
        ("where is the exit", "shows"),
        ("how tall are you", "answers"),
        ("", "answers"),
        ("!!", "answers"),
    ],
)
def test_a_sentence_takes_its_row(text: str, state: str) -> None:
    assert taken(OFFERED, text) == state


OFFERED = hearing(OFFER, PHRASES)


@for_each("data", [None, {}, {"result": None}, {"result": 3}, {"result": ["dance"]}, [], "dance"])
def test_what_is_no_text_takes_only_else(data: Any) -> None:
    after = step(OFFERED, initial(OFFERED).snapshot, Event("heard", data))
    assert after.snapshot.configuration == {"answers"}


@for_each(
    "text, name",
    [
        ("I'm Budi", "Budi"),
        ("Budi.", "Budi"),
        ("budi", "budi"),
        ("My name is Siti Nurhaliza", "Siti Nurhaliza"),
        ("My name is Budi and I am from Bandung", "Budi"),
        ("my name is anna from berlin", "anna"),
        ("I am Ludwig van Beethoven", "Ludwig van Beethoven"),
        ("My name is O'Brien", "O'Brien"),
        ("My name is محمد", "محمد"),
        ("Well, I am Dr. Hasan", "Dr. Hasan"),
        ("Happy Salma", "Happy Salma"),
        ("I am Robert, my name is Rob", "Rob"),
        ("My name is not Bob", None),
        ("My name is Not", "Not"),
        ("I am tired", None),
        ("I am the boss", None),
        ("What?", None),
        ("Bob?", None),
        ("dance", None),
        ("No", None),
        ("one two three four five", None),
    ],
)
def test_a_name_is_caught(text: str, name: str | None) -> None:
    machine = hearing({"me": "met", "else": "unmet"}, PHRASES)
    assert taken(machine, text) == ("met" if name else "unmet")
    assert not name or caught(machine, text)["name"] == name


@for_each(
    "text, slots",
    [
        ("exhibit three", {"n": 3}),
        ("exhibit 3", {"n": 3}),
        ("exhibit dua puluh tiga", {"n": 23}),
        ("exhibit two hundred three", {"n": 203}),
        ("take me to the clock please", {"exhibits": {"phrases": {"en": ["clock", "old clock"]}, "place": "hall"}}),
        ("take me to the old clock", {"exhibits": {"phrases": {"en": ["clock", "old clock"]}, "place": "hall"}}),
        ("remember that I like cake.", {"text": "that I like cake."}),
    ],
)
def test_a_slot_catches_its_type(text: str, slots: dict[str, Any]) -> None:
    lists = {"exhibits": [{"phrases": {"en": ["clock", "old clock"]}, "place": "hall"}]}
    phrases = {"go": {"en": ["exhibit {number:n}", "take me [to] the {exhibits}", "remember {text}"]}}
    found = caught(hearing({"go": "went"}, phrases, lists=lists), text)
    assert {name: found[name] for name in slots} == slots


def test_heard_has_the_text_the_phrase_and_the_answer() -> None:
    answers = {"faq": [{"phrases": {"en": ["how tall"], "id": ["tinggi"]}, "value": {"en": "Tall.", "id": "Tinggi."}}]}
    machine = hearing({"faq": "told", "dance": "danced"}, PHRASES, answers=answers)
    assert caught(machine, "Oh, how tall?") == {"text": "Oh, how tall?", "phrase": "how tall", "answer": "Tall."}
    assert caught(machine, "a Dance!") == {"text": "a Dance!", "phrase": "Dance", "answer": None}


def test_of_an_answer_that_is_a_list_one_is_drawn() -> None:
    colour = {"phrases": {"en": ["which colour"]}, "value": {"en": ["Blue.", "White."]}}
    answers = {"faq": [colour, {"phrases": {"en": ["how tall"]}, "value": {"en": "Small."}}]}
    told = {"target": ".", "actions": {"assign": {"caught": "pick(heard.answer)"}}}
    machine = hearing({"faq": told}, PHRASES, answers=answers)
    snapshot, drawn = initial(machine).snapshot, []
    for _ in range(20):
        snapshot = said(machine, "which colour", snapshot).snapshot
        drawn.append(snapshot.context["caught"])
    assert set(drawn) == {"Blue.", "White."}
    assert caught(machine, "how tall") == "Small."


def test_of_equal_rows_the_upper_one_is_taken_unless_its_guard_is_false() -> None:
    def of(*guards: str) -> Machine:
        rows = {name: {"guard": g, "target": name} for name, g in zip(("dance", "sing"), guards, strict=True)}
        return hearing({**rows, "else": "neither"}, PHRASES)

    assert taken(of("true", "true"), "sing and dance") == "dance"
    assert taken(of("false", "true"), "sing and dance") == "sing"
    assert taken(of("false", "false"), "sing and dance") == "neither"


def test_a_guard_that_fails_is_false_and_an_error_once() -> None:
    rows = {"dance": {"guard": "context.caught.x == 1", "target": "dance"}, "sing": "sings", "else": "neither"}
    machine = hearing(
        rows, PHRASES, more={"on": {"error.execution": {"actions": {"assign": {"most": "context.most + 1"}}}}}
    )
    for _ in range(3):  # by the whole algorithm, and by the written step
        after = said(machine, "sing and dance").snapshot
        assert (after.configuration, after.context["most"]) == ({"sings"}, 1)


def test_several_transitions_of_a_row_are_asked_in_their_order() -> None:
    rows = {
        "dance": [
            {"guard": "context.most > 0", "target": "danced"},
            {"target": "asked", "actions": {"assign": {"most": 1}}},
        ]
    }
    machine = hearing(rows, PHRASES)
    once = said(machine, "dance").snapshot
    assert once.configuration == {"asked"}
    assert said(machine, "dance", once).snapshot.configuration == {"danced"}


def _parallel(guide: dict[str, Any], other: dict[str, Any], root: dict[str, Any] | None = None) -> Machine:
    states = {"guide": {"states": {"asked": guide, "left": {}}}, "other": {"states": {"quiet": other, "moved": {}}}}
    return Machine.from_dict({"type": "parallel", "phrases": PHRASES, "states": states, **(root or {})})


def _in(machine: Machine, text: str) -> set[str]:
    return {name.rpartition(".")[2] for name in said(machine, text).snapshot.configuration} - {"guide", "other"}


@for_each(
    "text, states",
    [
        ("dance", {"asked", "moved"}),
        ("sing", {"left", "moved"}),
        ("hello there", {"left", "moved"}),
        ("Budi", {"left", "quiet"}),
    ],
)
def test_else_waits_for_every_region(text: str, states: set[str]) -> None:
    guide = {"hears": {"sing": "left", "me": "left", "else": "left"}}
    other = {"hears": {"dance": "moved", "else": "moved"}}
    if text == "sing":
        other = {"on": {"heard": "moved"}}
    assert _in(_parallel(guide, other), text) == states


def test_inner_states_come_first_and_on_before_hears_before_a_wildcard() -> None:
    def of(inner: dict[str, Any], outer: dict[str, Any]) -> Machine:
        states = {"outer": {"states": {"inner": inner}, **outer}, "a": {}, "b": {}, "c": {}}
        return Machine.from_dict({"phrases": PHRASES, "states": states})

    assert taken_at(of({"hears": {"dance": "#a"}}, {"hears": {"dance": "b"}}), "dance") == "a"
    assert taken_at(of({"hears": {"sing": "#a"}}, {"hears": {"dance": "b"}}), "dance") == "b"
    assert taken_at(of({"hears": {"else": "#a"}}, {"hears": {"dance": "b"}}), "dance") == "b"
    assert taken_at(of({"hears": {"else": "#a"}}, {"hears": {"else": "b"}}), "dance") == "a"
    assert taken_at(of({"hears": {"dance": "#a"}, "on": {"heard": "#b"}}, {}), "dance") == "b"
    assert taken_at(of({"hears": {"dance": "#a"}, "on": {"*": "#b"}}, {}), "dance") == "a"
    assert taken_at(of({"hears": {"else": "#a"}, "on": {"*": "#b"}}, {}), "dance") == "b"
    assert taken_at(of({"on": {"*": "#c"}}, {"hears": {"dance": "b"}}), "dance") == "c"


def taken_at(machine: Machine, text: str) -> str:
    return next(iter({*said(machine, text).snapshot.configuration} - {"outer", "outer.inner"}), "")


def test_else_leaves_what_is_said_to_an_invoked_behaviour() -> None:
    inner = {"phrases": PHRASES, "states": {"waits": {"hears": {"dance": "danced"}}, "danced": {}}}
    outer = {"states": {"asks": {"invoke": {"behavior": "inner"}, "hears": {"else": "left"}}, "left": {}}}
    machine = Machine.from_dict(outer, behaviors={"inner": inner})
    assert said(machine, "hello there").snapshot.configuration == {"asks"}
    deaf = {**inner, "states": {"waits": {"on": {"*": "danced"}}, "danced": {}}}
    assert said(Machine.from_dict(outer, behaviors={"inner": deaf}), "hello").snapshot.configuration == {"left"}


def test_the_entry_of_a_list_is_heard_as_it_is_now() -> None:
    ask = {"hears": {"question.right": "right", "else": "wrong"}}
    inner = {
        "ask": ask,
        "right": {"after": {"1s": "next"}},
        "wrong": {"after": {"1s": "next"}},
        "next": {"type": "final"},
    }
    states = {"quiz": {"for": {"each": "lists.quiz", "as": "question"}, "states": inner}}
    quiz = [{"right": {"en": ["nine", "(9|nine) pipes"]}}, {"right": ["jupiter"]}]
    machine = Machine.from_dict({"lists": {"quiz": quiz}, "states": states})
    first = initial(machine).snapshot
    assert "quiz.right" in said(machine, "it has nine pipes", first).snapshot.configuration
    assert "quiz.wrong" in said(machine, "Jupiter", first).snapshot.configuration


def test_this_state_again_is_left_and_entered() -> None:
    machine = hearing({"dance": "."}, PHRASES)
    again = said(machine, "dance")
    assert (again.exited, again.entered) == (("asked",), ("asked",))


def test_what_comes_again_is_the_same() -> None:
    for text in ("Dance, please.", "please don't sing", "why do you dance?", "No.", "hello there"):
        assert len({taken(OFFERED, text) for _ in range(4)}) == 1


def test_a_long_text_ends_however_many_ways_a_pattern_fits() -> None:
    machine = hearing({"any": "told", "else": "other"}, {"any": {"en": ["{text:a} x {text:b} x {text:c} x {name} y"]}})
    assert taken(machine, "a x " * 400) == "other"


def test_no_garbage_is_searched_for_while_phrases_are_compiled() -> None:
    phrases = {"dance": {"en": [f"dance number {number} of {number + 1}" for number in range(2000)]}}
    machine, searches = hearing({"dance": "."}, phrases), list[str]()

    def note(phase: str, _: dict[str, int]) -> None:
        searches.append(phase)

    gc.callbacks.append(note)
    try:
        hearing_of(machine)
    finally:
        gc.callbacks.remove(note)
    assert searches.count("start") <= 1  # the one that is due afterwards
