"""The fast path gives the step that the whole algorithm gives, or none: to the last digit, and in the same order."""

from contextlib import suppress
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lumen.errors import LumenError
from lumen.language.commands import Start
from lumen.statechart import Event, Interpreter, Machine, Snapshot, Step, due, fast_path, initial
from lumen.statechart.compiled_machine import compiled
from lumen.statechart.external_events import process
from lumen.statechart.invocations import open_context
from lumen.statechart.step_writer import StepWriter
from tests.tables import for_each

GUARDS = [
    "true",
    "context.n % 2 == 0",
    "context.n < 3 || event.data.x",
    "event.data.x > 1",
    "event.data.nothing",
    "In('r0.a')",
    "state.path == 'r0.a'",
    "hour() == 0",
    "context.n",
]
ASSIGNS = [
    {"n": "context.n + 1"},
    {"n": "context.n + 1", "m": "context.n"},
    {"n": "event.data.x"},
    {"n": "'text'"},
    {"m": [1, {"k": "context.n"}]},
    {"m": "1 / context.n"},
    {"m": "state.path"},
    {"m": "In('r1.b')"},
    {"m.k": "context.n"},
    {"m": {"k": {"x": 1}}, "m.k.x": "context.m.k.x + context.n"},
]
ROWS = st.fixed_dictionaries(
    {},
    optional={
        "target": st.sampled_from(["a", "b", "#r0.a", "#r1", "#r1.b"]),
        "guard": st.sampled_from(GUARDS),
        "actions": st.lists(st.sampled_from(ASSIGNS).map(lambda values: {"assign": values}), max_size=2),
        "reenter": st.booleans(),
    },
)


@st.composite
def machines(draw: st.DrawFn) -> Machine:
    """Return a random machine of two regions or states; it checks and assigns, and seldom does anything else."""

    def leaf() -> dict[str, Any]:
        data: dict[str, Any] = {
            "on": draw(st.dictionaries(st.sampled_from(["e", "f", "*"]), st.lists(ROWS, max_size=2)))
        }
        for key in ("entry", "exit"):
            if draw(st.integers(0, 3)) == 0:
                data[key] = {"assign": draw(st.sampled_from(ASSIGNS))}
        if draw(st.integers(0, 3)) == 0:
            data["after"] = {draw(st.sampled_from(["1s", "9s", "{{ context.n + 1 }}s"])): {"target": "b"}}
        rare = draw(st.integers(0, 30))
        return data | {0: {"entry": {"log": "x"}}, 1: {"always": {"guard": "context.n > 4", "target": "a"}}}.get(
            rare, {}
        )

    regions = {
        f"r{i}": {"states": {"a": leaf(), "b": leaf()}, "on": {"f": draw(st.lists(ROWS, max_size=1))}} for i in (0, 1)
    }
    for region in regions.values():
        for row in region["on"]["f"]:
            if row.get("target") in ("a", "b"):
                row["target"] = f".{row['target']}"
    kind = draw(st.sampled_from(["parallel", "compound"]))
    return Machine.from_dict({"type": kind, "context": {"n": 0, "m": None}, "states": regions})


def in_full(machine: Machine, snapshot: Snapshot, event: Event) -> Step:
    """Return the step without the fast path."""
    return process(open_context(compiled(machine), snapshot, event, max(event.at, snapshot.at)), event)


EVENTS = st.builds(
    Event,
    st.sampled_from(["e", "f", "g.h"]),
    st.sampled_from([None, {"x": 1}, {"x": 2.5}, {"x": True}]),
    st.floats(0, 9),
)


def quick(machine: Machine, snapshot: Snapshot, event: Event) -> Step | None:
    """Return the step of the fast path, None without one, at the third call: functions are written for what recurs."""
    steps = [compiled(machine).fast_paths.step(snapshot, event) for _ in range(3)]
    return steps[-1]


def same(machine: Machine, snapshot: Snapshot, event: Event) -> Step:
    """Return the step of the whole algorithm; the fast path must return the same, if it returns any."""
    taken, short = in_full(machine, snapshot, event), quick(machine, snapshot, event)
    if short is not None:
        assert short == taken
        assert repr(short) == repr(taken)
    return taken


@settings(max_examples=200, deadline=None)
@given(machines(), st.lists(EVENTS, max_size=15))
def test_a_shortcut_gives_the_step_of_the_whole_algorithm(machine: Machine, events: list[Event]) -> None:
    with suppress(LumenError):  # its `always` may go round without end
        snapshot = initial(machine).snapshot
        for event in events:
            snapshot = same(machine, snapshot, event).snapshot


INSTANT: list[dict[str, Any]] = [
    {"language": "id"},
    {"publish": {"route": "sound", "body": {"at": ["context.n"]}}},
    {"log": "{{ event.data.x }}"},
    {"raise": "g"},
    {"raise": {"event": "h", "data": {"x": "context.n"}}},
    {"assign": {"n": "context.n + 1"}},
    {"cancel": "nothing"},
]
SAID: list[dict[str, Any]] = [
    {"say": "{{ context.n }} of {{ state.path }}, {{ event.name }}"},
    {"say": {"en": ["one", "two", "{{ In('r0.a') }}"], "id": ["satu"]}},
    {"play": "dance"},
    *INSTANT,
    {"if": "context.n % 2 == 0", "then": {"say": "even"}, "else": [{"raise": "g"}, {"log": "odd"}]},
]
DONE: list[dict[str, Any]] = [
    {"parallel": [{"say": "a"}, {"play": "dance"}]},
    {"wait": "2s"},
    {"ask": {"question": "'why'", "within": "4s", "else": {"say": "who knows"}}},
    {"if": "context.n > 1", "then": [{"say": "more"}, {"say": "still"}], "else": {"log": "less"}},
]
SOME = st.lists(st.sampled_from(SAID), max_size=2)


@st.composite
def rows(draw: st.DrawFn) -> dict[str, Any]:
    data: dict[str, Any] = {"actions": draw(SOME)}
    if draw(st.booleans()):
        data["target"] = draw(st.sampled_from(["a", "b", "z", "#r0.b", "#r1.h"]))
    return data | ({"guard": draw(st.sampled_from(GUARDS[:4]))} if draw(st.booleans()) else {})


@st.composite
def lively(draw: st.DrawFn) -> Machine:
    """Return a random machine that speaks, raises events, runs sequences of actions, and has history states."""

    def leaf(kind: str) -> dict[str, Any]:
        data: dict[str, Any] = {key: draw(SOME) for key in ("entry", "exit") if draw(st.booleans())}
        if kind == "final":
            return {"type": kind, **data}
        if draw(st.booleans()):
            data["do"] = draw(st.lists(st.sampled_from(SAID + DONE), min_size=1, max_size=3))
            data["onDone"] = draw(st.lists(rows(), max_size=2))
            data["resume"] = draw(st.sampled_from(["again", "after", "never"]))
        on = {name: draw(st.lists(rows(), max_size=2)) for name in ("e", "g", "h") if draw(st.booleans())}
        return data | {"on": on, "after": {"3s": draw(rows())}}

    regions: dict[str, Any] = {}
    for name in ("r0", "r1"):
        back = {"target": draw(st.sampled_from([".a", ".b", ".b", ".h"])), "reenter": True}
        states = {"a": leaf("atomic"), "b": leaf("atomic"), "z": leaf("final"), "h": {"type": "history", "target": "a"}}
        regions[name] = {"states": states, "on": {"f": back}}
    kind = draw(st.sampled_from(["parallel", "compound"]))
    return Machine.from_dict({"type": kind, "context": {"n": 0, "m": None}, "states": regions})


GIVEN = st.builds(Event, st.sampled_from("eefgh"), st.just({"x": 1}), st.floats(0, 9))
ANSWERS = st.sampled_from(["done", "done", "done", "error", "cancelled", "timer"])
HAPPENINGS = st.lists(st.one_of(GIVEN, ANSWERS), min_size=8, max_size=15)


@settings(max_examples=100, deadline=None)
@given(lively(), HAPPENINGS, st.data())
def test_what_is_said_and_done_is_the_same(machine: Machine, happenings: list[Any], data: st.DataObject) -> None:
    with suppress(LumenError):
        taken = initial(machine, language="en", seed=7)
        started: list[str] = ["c0", "d99"]
        for number, happening in enumerate(happenings):
            started += [command.id for command in taken.commands if isinstance(command, Start)]
            event: Event | None = happening if isinstance(happening, Event) else due(taken.snapshot)
            if isinstance(happening, str) and happening != "timer":
                id = data.draw(st.sampled_from(started[-6:]))
                event = Event(f"{happening}.command.{id}", {"reason": "so"}, float(number))
            if event:
                taken = same(machine, taken.snapshot, event)


ADD = {"assign": {"n": "context.n + 1"}}
RING = {f"s{i}": {"on": {"go": {"guard": "context.n < 9", "target": f"s{(i + 1) % 3}"}}} for i in range(3)}
COUNTING = {
    f"s{i}": {"on": {"go": f"s{(i + 1) % 3}"}, "entry": ADD, "exit": ADD, "after": {"2s": "s0"}} for i in range(3)
}
SAY = {"say": {"en": ["one", "two"], "id": ["satu"]}}
SPEAKING = {f"s{i}": {"on": {"go": f"s{1 - i}"}, "entry": SAID[0], "do": [SAY, SAID[2]]} for i in range(2)}
INSTANTLY = {f"s{i}": {"on": {"go": f"s{1 - i}"}, "entry": INSTANT[:-1], "exit": SAID[-1]} for i in range(2)}
RAISING: dict[str, Any] = {
    "a": {"on": {"go": "b"}, "exit": {"raise": "left"}},
    "b": {"on": {"left": {"guard": "event.name == 'left'", "target": "c"}}},
    "c": {"do": {"say": "there"}, "onDone": "a"},
}
BACK = {"in": {"states": {"a": {}, "h": {"type": "history", "target": "a"}}, "on": {"go": "out"}}, "out": {}}
CHOOSING = {"a": {"on": {"go": [{"guard": f"context.n == {i}", "target": "b"} for i in range(3)]}}, "b": {}}
SETTLING = {
    "a": {"on": {"go": "b"}},
    "b": {
        "entry": ADD,
        "always": [{"guard": "context.n > 5", "target": "a"}, {"guard": "context.n > 0", "target": "c"}],
    },
    "c": {},
}
PLAIN: dict[str, dict[str, Any]] = {
    "a ring": {"states": RING},
    "counting on the way": {"states": COUNTING},
    "two regions": {"type": "parallel", "states": {"l": {"states": RING}, "r": {"states": RING}}},
    "speaking": {"states": SPEAKING},
    "all that takes no time": {"states": INSTANTLY},
    "raising": {"states": RAISING},
    "leaving a history": {"states": BACK},
    "one of many ways": {"states": CHOOSING},
    "going on at once": {"states": SETTLING},
}


@for_each("name", PLAIN)
def test_plain_steps_are_taken_short(name: str) -> None:
    machine = Machine.from_dict({"context": {"n": 0}, **PLAIN[name]})
    snapshot = initial(machine, language="en").snapshot
    for event in (Event("go", {"x": 1}, 1.0), Event("nothing"), Event("done.command.c1")):
        assert quick(machine, snapshot, event) == same(machine, snapshot, event)


def test_a_do_goes_on_short() -> None:
    machine = Machine.from_dict({"states": RAISING, "context": {"n": 0}})
    snapshot = same(machine, initial(machine).snapshot, Event("go")).snapshot
    answer = Event("done.command.d1", at=2.0)
    taken = same(machine, snapshot, answer)
    assert quick(machine, snapshot, answer) == taken
    assert taken.snapshot.configuration == {"a"}


def test_a_question_without_an_answer_goes_on_short() -> None:
    do = {"ask": {"question": "'why'", "within": "4s", "else": {"say": "who knows"}}}
    machine = Machine.from_dict({"states": {"a": {"on": {"go": "b"}}, "b": {"do": do}}})
    snapshot = same(machine, initial(machine).snapshot, Event("go")).snapshot
    answer = Event("done.command.d1", at=2.0)
    taken = same(machine, snapshot, answer)
    assert quick(machine, snapshot, answer) == taken
    assert not taken.snapshot.timers
    assert taken.commands


def test_a_guard_of_two_regions_is_asked_once() -> None:
    region = {"states": {"a": {"on": {"go": {"guard": "context.n < 9", "target": "b"}}}, "b": {}}}
    machine = Machine.from_dict({"type": "parallel", "context": {"n": 0}, "states": {"l": region, "r": region}})
    planner = compiled(machine).planner
    start = planner.configuration(frozenset({"l", "l.a", "r", "r.a"}))
    writer = StepWriter(planner, start)
    assert writer.heard(start.candidates("go"))
    assert writer.text().count("9") == 2  # a number, and what is no number


def test_what_happens_once_is_not_written() -> None:
    machine = Machine.from_dict({"context": {"n": 0}, "states": RING})
    snapshot, event, paths = initial(machine).snapshot, Event("go"), compiled(machine).fast_paths
    assert paths.step(snapshot, event) is None
    assert paths.step(snapshot, event) == in_full(machine, snapshot, event)


def test_what_never_comes_to_rest_is_not_written() -> None:
    machine = Machine.from_dict(
        {
            "states": {
                "s": {"on": {"go": "a"}},
                "a": {"always": "b"},
                "b": {"always": {"guard": "In('b')", "target": "a"}},
            }
        }
    )
    snapshot = initial(machine).snapshot
    assert quick(machine, snapshot, Event("go")) is None


def test_a_first_visit_writes_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    written: list[Any] = []
    monkeypatch.setattr(fast_path, "StepWriter", lambda *given: written.append(given))
    interpreter = Interpreter(Machine.from_dict({"context": {"n": 0}, "states": RING}))
    interpreter.start()
    for _ in range(3):
        interpreter.send("go")
    assert not written
    interpreter.send("go")
    assert written


def test_a_step_can_be_read() -> None:
    machine = Machine.from_dict({"context": {"n": 0}, "states": RING})
    planner = compiled(machine).planner
    start = planner.configuration(frozenset({"s0"}))
    writer = StepWriter(planner, start)
    writer.heard(start.candidates("go"))
    _, body = writer.text().split("    try:")
    assert [line.strip() for line in body.splitlines() if "Snapshot" not in line] == [
        "",
        "if (v0 < 9 if type((v0 := context['n'])) in numbers else less(v0, 9)):",
        "return new(Step, (event, c1, c2, (), after, c3, (), ()))",
        "return new(Step, (event, (), (), (), after, (), (), ()))",
        "except Exception:",
        "return None",
    ]
    assert writer.constants[:3] == [{"s1"}, ("s0",), ("s1",)]
