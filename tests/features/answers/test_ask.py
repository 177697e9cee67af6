"""`ask` in a `do`: the question, the sentences of an answer that are spoken, and the actions if none comes."""

import json
from typing import Any

import pytest

from lumen.insight.migration.situation import can_continue
from lumen.language.commands import Ask, Cancel, Say, Start
from lumen.statechart import Event, Machine, Snapshot, Step, deserialize, due, initial, serialize, step
from tests.tables import for_each

DATA: dict[str, Any] = {
    "id": "talk",
    "context": {"visitor": "Ani Putri", "guest": "Budi", "topic": "robots", "wish": ""},
    "states": {
        "idle": {"on": {"heard": {"target": "asked", "actions": {"assign": {"wish": "event.data.result"}}}}},
        "asked": {
            "do": [{"ask": {"question": "context.wish", "within": "4s", "else": {"say": "I do not know."}}}],
            "on": {"leave": "idle"},
            "onDone": "over",
            "onError": "broken",
        },
        "over": None,
        "broken": None,
    },
}
MACHINE = Machine.from_dict(DATA)


class Talk:
    """A behaviour after a visitor's question; `said` are its spoken texts; `at` is the time of an event [s]."""

    def __init__(self, machine: Machine = MACHINE, question: Any = "how tall are you") -> None:
        self.machine, self.steps = machine, list[Step]()
        self.snapshot: Snapshot = initial(machine, language="en").snapshot
        self.hear("heard", {"result": question})

    def hear(self, name: str, data: Any = None, at: float = 1.0) -> None:
        self.take(Event(name, data, at))

    def take(self, event: Event) -> None:
        self.steps.append(step(self.machine, self.snapshot, event))
        self.snapshot = self.steps[-1].snapshot

    def time_passes(self) -> None:
        ended = due(self.snapshot)
        assert ended
        self.take(ended)

    @property
    def asked(self) -> list[tuple[str, Ask]]:
        return [(c.id, c.command) for c in self.commands if isinstance(c, Start) and isinstance(c.command, Ask)]

    @property
    def said(self) -> list[tuple[str, str]]:
        return [(c.id, c.command.text) for c in self.commands if isinstance(c, Start) and isinstance(c.command, Say)]

    @property
    def commands(self) -> list[Any]:
        return [command for one in self.steps for command in one.commands]

    @property
    def state(self) -> str:
        return next(iter(self.snapshot.configuration))


def test_an_answer_is_said_and_then_it_is_over() -> None:
    talk = Talk()
    assert talk.asked == [("d1", Ask("how tall are you", "en", 4.0))]
    talk.hear("answer.command.d1", {"text": "I am small.", "language": "en", "source": "passage"})
    assert talk.said == [("d2", "I am small.")]
    assert not talk.snapshot.timers
    talk.hear("done.command.d2")
    assert talk.state == "over"


def test_nobody_answers_in_time_and_what_comes_then_is_ignored() -> None:
    talk = Talk()
    assert due(talk.snapshot) == Event("wait.w1", None, 5.0, "w1")
    talk.time_passes()
    assert talk.said == [("d2", "I do not know.")]
    assert Cancel("d1") in talk.commands
    talk.hear("answer.command.d1", {"text": "Too late."}, at=5.1)
    talk.hear("done.command.d2", at=6.0)
    assert (len(talk.said), talk.state) == (1, "over")


@pytest.mark.parametrize("kind", ["error", "cancelled", "lost", "done"])
def test_what_fails_answers_nothing(kind: str) -> None:
    talk = Talk()
    talk.hear(f"{kind}.command.d1", {"reason": "nobody"})
    assert [text for _, text in talk.said] == ["I do not know."]


def test_sentences_are_said_as_they_come_and_the_time_counts_for_all_of_them() -> None:
    talk = Talk()
    talk.hear("answer.command.d1", {"text": "One.", "more": True})
    talk.hear("done.command.d2", at=2.0)
    assert talk.state == "asked"
    talk.hear("answer.command.d1", {"text": "Two."}, at=3.0)
    talk.hear("done.command.d3", at=4.0)
    assert ([text for _, text in talk.said], talk.state) == (["One.", "Two."], "over")


def test_an_answer_that_breaks_off_is_said_as_far_as_it_came() -> None:
    talk = Talk()
    talk.hear("answer.command.d1", {"text": "One.", "more": True})
    talk.time_passes()
    assert talk.state == "asked"
    talk.hear("done.command.d2", at=6.0)
    assert ([text for _, text in talk.said], talk.state) == (["One."], "over")


def test_sentences_without_end_are_cut() -> None:
    talk = Talk()
    for _ in range(20):
        talk.hear("answer.command.d1", {"text": "More.", "more": True})
    assert len(talk.said) == 5


def test_a_filler_is_said_once_and_answers_nothing() -> None:
    talk = Talk()
    talk.hear("answer.command.d1", {"text": "Let me think.", "filler": True})
    talk.hear("answer.command.d1", {"text": "Let me think.", "filler": True})
    talk.time_passes()
    assert [text for _, text in talk.said] == ["Let me think.", "I do not know."]
    answered = Talk()
    answered.hear("answer.command.d1", {"text": "Hm.", "filler": True})
    answered.hear("answer.command.d1", {"text": "Yes."})
    answered.hear("done.command.d3")
    assert answered.state == "asked"
    answered.hear("done.command.d2")
    assert answered.state == "over"


def test_who_leaves_hears_no_answer() -> None:
    talk = Talk()
    talk.hear("leave")
    talk.hear("answer.command.d1", {"text": "I am small."})
    assert (talk.said, talk.snapshot.timers, talk.state) == ([], (), "idle")
    assert Cancel("d1") in talk.commands


@for_each("data", [None, "text", {}, {"text": 5}, {"text": ""}, {"text": "^{}"}, {"text": "x" * 501}, {"text": ["a"]}])
def test_what_is_no_answer_is_ignored(data: Any) -> None:
    talk = Talk()
    talk.hear("answer.command.d1", data)
    talk.hear("answer.command.d7", {"text": "Another's."})
    assert talk.said == []
    talk.time_passes()
    assert [text for _, text in talk.said] == ["I do not know."]


def test_nobody_answers_another_command_so() -> None:
    machine = Machine.from_dict({"states": {"a": {"do": {"play": "dance"}, "onDone": "b"}, "b": None}})
    first = initial(machine)
    after = step(machine, first.snapshot, Event("answer.command.d1", {"text": "Done."}))
    assert (after.commands, after.snapshot.configuration) == ((), {"a"})


@pytest.mark.parametrize(
    ("text", "spoken"),
    [
        ("{{ context.visitor }} is here", "context.visitor is here"),
        ("^start(animations/Hey_1) Hello \\rspd=50\\ you", "start(animations/Hey 1) Hello rspd=50 you"),
        ("<say-as>one</say-as>\u0000\n two", "say-as one /say-as two"),
    ],
)
def test_an_answer_is_data(text: str, spoken: str) -> None:
    talk = Talk()
    talk.hear("answer.command.d1", {"text": text})
    assert [said for _, said in talk.said] == [spoken]


@pytest.mark.parametrize(
    ("heard", "asked"),
    [
        ("I am Ani Putri, how tall are you", "I am , how tall are you"),
        ("does ANI like robots, Budi", "does like robots,"),
        ("a\u0000b\n  c", "a b c"),
        ("word " * 1000, ("word " * 200).strip()),
    ],
)
def test_names_are_not_asked(heard: str, asked: str) -> None:
    assert Talk(question=heard).asked[0][1].question == asked


def test_a_question_that_is_no_text_is_an_error() -> None:
    context = {**DATA["context"], "wish": 0}
    assert Talk(Machine.from_dict({**DATA, "context": context}), 5).state == "broken"


def test_two_questions_at_once_have_an_answer_each() -> None:
    ask = DATA["states"]["asked"]["do"][0]
    states = {**DATA["states"], "asked": {**DATA["states"]["asked"], "do": [{"parallel": [ask, ask]}]}}
    talk = Talk(Machine.from_dict({**DATA, "states": states}))
    assert [id for id, _ in talk.asked] == ["d1", "d2"]
    talk.hear("answer.command.d2", {"text": "Two."})
    talk.hear("answer.command.d1", {"text": "One."})
    talk.hear("done.command.d3")
    talk.hear("done.command.d4")
    assert ([text for _, text in talk.said], talk.state) == (["Two.", "One."], "over")


def test_what_comes_behind_it_waits_and_what_stands_in_else_takes_its_time() -> None:
    block = {"ask": {"question": "'?'", "within": "1s", "else": [{"wait": "1s"}, {"say": "No."}]}}
    states = {**DATA["states"], "asked": {"do": [block, {"say": "Next."}], "onDone": "over"}}
    talk = Talk(Machine.from_dict({**DATA, "states": states}))
    talk.time_passes()
    talk.time_passes()
    assert talk.said == [("d2", "No.")]
    talk.hear("done.command.d2", at=4.0)
    assert [text for _, text in talk.said] == ["No.", "Next."]


def test_an_invoked_behaviour_asks_under_its_own_id() -> None:
    inner = {**DATA, "states": {"asked": DATA["states"]["asked"] | {"on": {}}, "over": None, "broken": None}}
    machine = Machine.from_dict({"states": {"a": {"invoke": {"behavior": "talk"}}}}, behaviors={"talk": inner})
    first = initial(machine, language="en")
    assert [command.id for command in first.commands if isinstance(command, Start)] == ["d1@talk"]
    after = step(machine, first.snapshot, Event("answer.command.d1@talk", {"text": "Yes."}))
    assert after.commands == (Start("d2@talk", Say("Yes.", "en")),)


def test_it_is_kept_while_it_waits_and_goes_on_under_other_texts() -> None:
    talk = Talk()
    kept = json.loads(json.dumps(serialize(talk.machine, talk.snapshot)))
    talk.snapshot = deserialize(talk.machine, kept)
    talk.hear("answer.command.d1", {"text": "Still here."})
    assert [text for _, text in talk.said] == ["Still here."]
    before = MACHINE.states["asked"].do
    ask = {"question": "context.topic", "within": "9s", "else": {"say": "No idea."}}
    other = {**DATA["states"], "asked": {**DATA["states"]["asked"], "do": [{"ask": ask}]}}
    after = Machine.from_dict({**DATA, "states": other}).states["asked"].do
    assert can_continue(before, after, talk.snapshot.doing["asked"])
    waits = Machine.from_dict({**DATA, "states": {**other, "asked": {"do": {"wait": "1s"}}}})
    assert not can_continue(before, waits.states["asked"].do, talk.snapshot.doing["asked"])


@for_each(
    ("leads", "state"),
    [
        ({"wish": {"target": "over", "offer": True}}, "over"),
        ({"wish": {"target": "over"}}, "asked"),
        ({"*": {"target": "over", "offer": True}}, "asked"),
        ({"wish": {"target": "over", "offer": True, "approve": "operator"}}, "asked"),
        ({"wish": {"target": "over", "offer": True, "guard": "event.data.times > 2"}}, "over"),
        ({"wish": {"target": "over", "offer": True, "guard": "event.data.times > 5"}}, "asked"),
    ],
)
def test_an_answer_raises_an_event_that_is_offered(leads: dict[str, Any], state: str) -> None:
    asked = {**DATA["states"]["asked"], "on": leads}
    asked.pop("onDone")
    schema = {"type": "object", "properties": {"times": {"type": "integer"}}, "required": ["times"]}
    machine = Machine.from_dict({**DATA, "events": {"wish": schema}, "states": {**DATA["states"], "asked": asked}})
    talk = Talk(machine)
    talk.hear("answer.command.d1", {"raise": {"event": "wish", "data": {"times": 3}}})
    assert (talk.state, talk.said) == (state, [])
