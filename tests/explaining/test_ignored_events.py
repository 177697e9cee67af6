"""Why an event changed nothing."""

from typing import Any

from lumen.insight.explaining.ignored_events import ignored
from lumen.language.events import Event
from lumen.run.ignoring import BURST, IgnoredEvents
from lumen.statechart import Machine, initial, step
from tests.tables import for_each

GUIDE: dict[str, Any] = {
    "type": "parallel",
    "context": {"tries": 0},
    "phrases": {"dance": {"en": ["dance"]}, "stop": {"en": ["stop"]}},
    "states": {
        "guide": {
            "initial": "offer",
            "states": {
                "offer": {
                    "id": "offer",
                    "on": {
                        "heard": [
                            {"guard": "heard(event.data.result, 'dance')", "target": "goodbye"},
                            {"guard": "context.tries > 2 && hour() < 25", "target": "goodbye"},
                        ]
                    },
                },
                "goodbye": {"id": "goodbye", "on": {"*": {"guard": "false", "target": "offer"}}},
            },
        },
        "touch": {"on": {"touched": {"guard": "event.data.sensor == 'Head'", "actions": {"log": "touched"}}}},
    },
}


def told(*said: tuple[str, Any], at: float = 10.0) -> str:
    """Return the explanation of the last of these events."""
    machine, how, line = Machine.from_dict(GUIDE, "guide"), IgnoredEvents(), ""
    now = initial(machine).snapshot
    for number, (name, data) in enumerate(said):
        taken = step(machine, now, Event(name, data, at * number))
        now, line = taken.snapshot, how.line(machine, taken)
    return line


DANCE, SING = ("heard", {"result": "dance"}), ("heard", {"result": "sing"})


@for_each(
    ("events", "line"),
    [
        ([DANCE], ""),
        ([DANCE, DANCE], "“dance” while goodbye does not listen"),
        (
            [SING],
            "“sing” while heard(event.data.result, 'dance') is false in offer,"
            " and context.tries > 2 && hour() < 25 is false in offer (context.tries is 0, hour() is 0)",
        ),
        (
            [("touched", {"sensor": "Foot"})],
            "touched while event.data.sensor == 'Head' is false in touch (event.data.sensor is 'Foot')",
        ),
        ([("touched", {"sensor": "Head"})], ""),
        ([("unknown", None)], ""),
        ([("done.command.d1", None)], ""),
    ],
)
def test_it_says_who_did_not_listen_or_which_guards_were_false(events: list[tuple[str, Any]], line: str) -> None:
    assert told(*events) == line


def test_what_happens_many_times_a_second_is_told_once() -> None:
    assert told(DANCE, DANCE, at=BURST * 0.9) == ""
    assert told(DANCE, SING, at=BURST * 0.9) == "“sing” while goodbye does not listen"
    assert told(SING, SING, SING, at=BURST * 1.1) != ""


def test_an_invoked_behaviour_that_hears_nothing_is_named_with_its_id() -> None:
    quiz = {"initial": "ask", "states": {"ask": {"id": "ask", "on": {"heard": {"guard": "1 > 2", "target": "ask"}}}}}
    host = {"initial": "playing", "states": {"playing": {"id": "playing", "invoke": {"behavior": "quiz"}}}}
    machine = Machine.from_dict(host, "host", behaviors={"quiz": quiz})
    found = ignored(machine, step(machine, initial(machine).snapshot, Event("heard", {"result": "?"})))
    assert found
    assert [(guard.state, guard.guard.source) for guard in found.refused] == [("quiz/ask", "1 > 2")]


def test_a_time_that_comes_and_a_do_that_ends_may_meet_false_guards() -> None:
    waiting: dict[str, Any] = {
        "id": "waiting",
        "do": {"say": {"en": "Hello"}},
        "onDone": {"guard": "context.n > 1", "target": "end"},
        "after": {"2s": {"guard": "context.n > 2", "target": "end"}},
    }
    machine = Machine.from_dict({"context": {"n": 1}, "states": {"waiting": waiting, "end": {}}}, "m")
    now = initial(machine).snapshot
    late = step(machine, now, Event("after.2s.waiting", None, 2.0, "after.2s.waiting"))
    assert IgnoredEvents().line(machine, late) == "after 2s while context.n > 2 is false in waiting (context.n is 1)"
    done = step(machine, now, Event("done.command.d1", None, 1.0))
    assert IgnoredEvents().line(machine, done) == "onDone while context.n > 1 is false in waiting (context.n is 1)"
