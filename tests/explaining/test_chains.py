"""Each kind of cause that a chain may lead over, on small machines."""

from typing import Any

import pytest

from lumen.errors import UsageError
from lumen.insight.explaining import RecordedStep
from lumen.insight.explaining.answers import why, why_not
from lumen.language.causes import Cause
from lumen.language.events import Event
from lumen.statechart import Machine, Snapshot, Step, due, initial, step
from lumen.statechart.direct_entry import entered_directly


class Play:
    """A machine with the steps that it has taken."""

    def __init__(self, data: dict[str, Any], **behaviors: dict[str, Any]) -> None:
        self.machine = Machine.from_dict({"id": "m", **data}, behaviors=behaviors)
        self.steps = [RecordedStep(self.machine, None, initial(self.machine))]

    @property
    def now(self) -> Snapshot:
        return self.steps[-1].step.snapshot

    def take(self, taken: Step) -> None:
        self.steps.append(RecordedStep(self.machine, self.now, taken))

    def happen(self, name: str, data: Any = None, cause: Cause | None = None) -> None:
        self.take(step(self.machine, self.now, Event(name, data, self.now.at + 1.0, cause=cause)))

    def wait(self) -> None:
        event = due(self.now)
        assert event
        self.take(step(self.machine, self.now, event))

    def why(self, what: str = "") -> list[str]:
        return [f"{link.kind}: {link.text}" for link in why(self.steps, what).links]


def test_what_was_raised_leads_to_the_action_that_raised_it() -> None:
    play = Play(
        {
            "initial": "a",
            "states": {
                "a": {"on": {"go": {"actions": [{"raise": "inner"}]}, "inner": "b"}},
                "b": {"always": "c"},
                "c": {"entry": {"play": "wave"}},
            },
        }
    )
    play.happen("go")
    assert play.why("wave") == [
        "command: plays wave",
        "activity: in the `entry` of c",
        "transition: b → c, as soon as possible",
        "transition: a → b, on inner",
        "event: raised inner",
        "transition: a → (stays), on go",
        "event: go",
    ]


def test_timers_lead_to_the_step_that_set_them() -> None:
    play = Play(
        {
            "initial": "a",
            "states": {
                "a": {"on": {"go": "b"}},
                "b": {
                    "entry": {"send": {"event": "later", "delay": "2s"}},
                    "do": [{"wait": "1s"}, {"say": "Now"}],
                    "on": {"later": "c"},
                },
                "c": {"after": {"5s": "d"}},
                "d": {},
            },
        }
    )
    play.happen("go")
    play.wait()
    start = ["transition: a → b, on go", "event: go"]
    now = ["command: says “Now”", "activity: 2nd of 2 in the `do` of b"]
    assert play.why("now") == [*now, "timer: wait of 1 s in b", *start]
    play.wait()
    sent = ["timer: later, 2 s after it was sent", "activity: sends later after 2 s", *start]
    assert play.why("c") == ["transition: b → c, on later", *sent]
    play.wait()
    after = ["transition: c → d, after 5 s", "timer: after 5 s in c", "transition: b → c, on later"]
    assert play.why("d") == [*after, *sent]


def test_a_do_that_failed_leads_to_the_answer() -> None:
    states = {"a": {"on": {"go": "b"}}, "b": {"do": [{"play": "p"}], "onError": "b"}}
    play = Play({"initial": "a", "states": states})
    play.happen("go")
    play.happen("error.command.d1", {"reason": "it fell"})
    assert play.why("b") == [
        "transition: b → b, when it fails",
        "activity: the `do` of b failed",
        "event: d1 failed: it fell",
        "command: plays p",
        "activity: in the `do` of b",
        "transition: a → b, on go",
        "event: go",
    ]


def test_it_ends_at_a_person_a_file_or_the_start() -> None:
    play = Play({"initial": "a", "states": {"a": {"entry": {"play": "first"}, "on": {"stop": "b"}}, "b": {}, "c": {}}})
    assert play.why("first")[-1] == "start: m begins"
    play.happen("stop", {"by": "Ani"})
    assert play.why("b")[-1] == "person: Ani requested it"
    goto = Event("operator.goto", {"by": "Budi", "state": "c"}, play.now.at)
    play.take(entered_directly(play.machine, play.now, "c", goto))
    assert play.why("c") == ["person: Budi moved the behaviour to c with `lumen goto`"]
    play.take(Step(None, ("c",), ("a",), (), play.now._replace(configuration=frozenset("a"))))
    assert play.why("a") == ["file: the files were saved and reloaded during the run"]


def test_a_message_says_its_key_its_sender_and_its_id() -> None:
    play = Play({"initial": "a", "states": {"a": {"on": {"heard": "b"}}, "b": {}}})
    play.happen("heard", {"result": "hello"}, Cause("message", "m7", "lumen.audio", "ears"))
    link = why(play.steps, "b").links[-1]
    assert (link.kind, link.id, dict(link.values)) == ("message", "m7", {"key": "lumen.audio", "sender": "ears"})


QUIZ: dict[str, Any] = {
    "id": "quiz",
    "initial": "ask",
    "context": {"tries": 0},
    "states": {
        "ask": {
            "do": {"say": "How many legs?"},
            "on": {
                "heard": [
                    {"guard": "event.data.result == 'four'", "target": "right"},
                    {"target": "ask", "actions": {"assign": {"tries": "context.tries + 1"}}},
                ]
            },
        },
        "right": {"entry": {"play": "yes"}, "after": {"1s": "end"}},
        "end": {"type": "final", "output": "context.tries"},
    },
}


def test_behaviors_within_others() -> None:
    playing = {"invoke": {"id": "quiz", "behavior": "quiz", "onDone": "thanks"}}
    states = {"idle": {"on": {"go": "playing"}}, "playing": playing, "thanks": {"do": {"say": "Thank you"}}}
    play = Play({"initial": "idle", "states": states}, quiz=QUIZ)
    play.happen("go")
    assert play.why("legs")[1:] == [
        "activity: in the `do` of quiz/ask",
        "activity: playing invokes quiz",
        "transition: idle → playing, on go",
        "event: go",
    ]
    play.happen("heard", {"result": "two"})
    [reason] = why_not(play.steps, "quiz/right").reasons
    assert (reason.because, reason.change) == ("guard", {"event.data.result": "four"})
    play.happen("heard", {"result": "four"})
    right = [
        "transition: quiz/ask → quiz/right, on heard, as event.data.result == 'four'",
        'event: heard {"result": "four"}',
    ]
    assert play.why("quiz/right") == right
    play.wait()
    assert play.why("thank you")[2:] == [
        "transition: playing → thanks, when it is done",
        "event: the behaviour quiz is done",
        "transition: quiz/right → quiz/end, after 1 s",
        "timer: after 1 s in quiz/right",
        *right,
    ]


def test_an_inner_state_comes_before_an_outer_one() -> None:
    inner = {"a": {"on": {"go": {"guard": "!context.busy", "target": "b"}}}, "b": {}}
    outer = {"initial": "a", "on": {"go": "c"}, "states": inner}
    play = Play({"initial": "outer", "context": {"busy": False}, "states": {"outer": outer, "c": {}}})
    play.happen("go")
    [reason] = why_not(play.steps, "c").reasons
    assert (reason.because, reason.change) == ("preempted", {"context.busy": True})
    assert "outer.a → outer.b, on go, as !context.busy was taken instead" in reason.text


def test_a_do_that_has_not_come_so_far() -> None:
    play = Play({"initial": "a", "states": {"a": {"do": [{"say": "One"}, {"say": "Two"}, {"say": "Three"}]}}})
    near, far = why_not(play.steps, "two").reasons, why_not(play.steps, "three").reasons
    assert near[0].change == {"event": "done.command.d1"}
    assert far[0].note == "other actions come before it"
    assert "it is at step 1 of 3 and waits for d1" in far[0].text


def test_a_chain_without_end_shows_both_ends() -> None:
    tick = {"send": {"event": "tick", "delay": "1s"}}
    states = {"a": {"entry": tick, "on": {"tick": {"actions": [tick, {"play": "p"}]}}}}
    play = Play({"initial": "a", "states": states})
    for _ in range(100):
        play.wait()
    links = play.why("p")
    assert len(links) < 90
    assert any("more of this kind" in link for link in links)
    assert links[-1] == "start: m begins"


def test_nothing_has_happened() -> None:
    with pytest.raises(UsageError, match="the journal has no entries from that time"):
        why([])
    with pytest.raises(UsageError, match="the journal has no entries from that time"):
        why_not([], "a")
