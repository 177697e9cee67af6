"""Machines of XState from bug reports and other systems: nothing is lost or misread without a finding."""

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from lumen.features.formats_charts.xstate import read_xstate
from lumen.language.diagnostics import Diagnostic
from lumen.project.formats.conversion_findings import ForeignFileError
from lumen.statechart import Interpreter, Machine
from tests.reports.test_scxml import messages
from tests.tables import for_each

INPUTS = Path(__file__).parent / "inputs" / "charts"


def xstate(source: str | dict[str, Any]) -> tuple[dict[str, Any], list[Diagnostic]]:
    """Read an input file or a machine; return its data and findings."""
    content = (INPUTS / source).read_bytes() if isinstance(source, str) else json.dumps(source).encode()
    data, found = read_xstate("chart.json", content, "chart")
    Machine.from_dict(data)
    return data, found


def test_a_state_of_version_4_that_is_its_own_target_is_left_and_entered() -> None:
    data, found = xstate("xstate4-self.json")
    it = Interpreter(Machine.from_dict(data))
    it.start()
    step = it.send("PING")
    assert (step.exited, step.entered) == (("waiting",), ("waiting",))
    assert [d.message for d in found] == ["the code of the guard `ready` is not in the file"]


@for_each(
    ("target", "way"),
    [
        ("b", {"target": "b"}),
        ({"target": "b", "internal": True}, {"target": ".b1"}),
        ("#deep", {"target": ".b2", "reenter": True}),
        (".b2", {"target": ".b2"}),
        ({"target": ".b2", "internal": False}, {"target": ".b2", "reenter": True}),
        ({"target": "b", "in": "#deep"}, {"target": "b", "guard": "In('deep')"}),
        ({"target": "b", "in": "#deep", "cond": "ready"}, {"target": "b", "guard": "In('deep') && (context.ready)"}),
    ],
)
def test_ways_within_a_state_of_version_4(target: Any, way: dict[str, Any]) -> None:
    states = {"b1": {}, "b2": {"id": "deep"}}
    chart = {"schema": {}, "initial": "b", "states": {"b": {"on": {"E": target}, "initial": "b1", "states": states}}}
    found = xstate(chart)[0]["states"]["b"]["on"]["E"]
    assert (found if isinstance(found, dict) else {"target": found}) == way


def test_sends_of_version_4_are_carried_over() -> None:
    data, found = xstate("xstate4-send.json")
    assert found == []
    assert data["states"]["a"] == {
        "entry": [{"send": {"event": "LATER", "delay": "1s", "id": "LATER"}}],
        "exit": [{"cancel": "LATER"}],
        "on": {"LATER": "b"},
    }


@for_each(
    ("action", "ours"),
    [
        ({"type": "xstate.raise", "event": "E"}, {"raise": "E"}),
        ({"type": "xstate.raise", "event": {"type": "E", "by": 1}}, {"raise": {"event": "E", "data": {"by": 1}}}),
        (
            {"type": "xstate.raise", "params": {"event": {"type": "E"}, "delay": 5}},
            {"send": {"event": "E", "delay": "5ms"}},
        ),
        ({"type": "xstate.send", "event": {"type": "E"}}, {"send": "E"}),
        ({"type": "xstate.send", "event": {"type": "E"}, "to": "#_parent"}, {"send": {"event": "E", "to": "parent"}}),
        ({"type": "xstate.cancel", "sendId": "x"}, {"cancel": "x"}),
        ({"type": "xstate.log", "label": "at", "expr": 3}, {"log": "at: 3"}),
        ({"type": "xstate.assign", "assignment": {"n": 2, "t": "two"}}, {"assign": {"n": 2, "t": "'two'"}}),
    ],
)
def test_actions_of_xstate_itself(action: dict[str, Any], ours: dict[str, Any]) -> None:
    chart = {"context": {"n": 0, "t": ""}, "states": {"a": {"entry": action, "on": {"E": {}}}}}
    data, found = xstate(chart)
    assert (data["states"]["a"]["entry"], found) == ([ours], [])


@for_each(
    ("action", "found"),
    [
        ({"type": "xstate.send"}, "`xstate.send`: its event is not in the file"),
        ({"type": "xstate.send", "event": "E", "delay": "soon"},
         "`xstate.send`: the delay `soon` is not a number of milliseconds"),
        ({"type": "xstate.cancel"}, "`xstate.cancel`: `sendId` is not in the file"),
        ({"type": "xstate.log"}, "`xstate.log`: its code is not in the file"),
        ({"type": "xstate.assign", "assignment": {}}, "`xstate.assign`: its code is not in the file"),
        ({"type": "xstate.assign", "assignment": {"n": 1, "m": 1}}, "`m` is not in the context"),
        ({"type": "xstate.send", "event": "E", "dely": 3}, "`dely` of an xstate.send has no counterpart in Lumen"),
        ({"type": "xstate.send", "params": {"event": "E", "dely": 3}},
         "`dely` of an xstate.send has no counterpart in Lumen"),
        ({"type": "xstate.send", "event": "E", "params": {"event": "F"}},
         "`event` in `params` of an xstate.send is left out"),
        ({"type": "xstate.send", "event": "E", "params": "soon"}, "`params` of an xstate.send is not an object"),
    ],
)  # fmt: skip
def test_missing_parts_of_an_xstate_action_are_listed(action: dict[str, Any], found: str) -> None:
    said = xstate({"context": {"n": 0}, "states": {"a": {"entry": action, "on": {"E": {}}}}})[1]
    assert found in [d.message for d in said]


@for_each(
    ("state", "found"),
    [
        ({"onn": {"E": "a"}}, "`onn` of a state has no counterpart in Lumen"),
        ({"onEntry": "ring"}, "`onEntry` of a state: write `entry`"),
        ({"on": {"E": {"target": "a", "reenter": "yes"}}}, "`reenter` can't be `yes`"),
        ({"on": {"E": {"target": "a", "guards": "x"}}}, "`guards` of a transition has no counterpart in Lumen"),
        ({"on": {"E": {"target": "a", "guard": "x", "cond": "y"}}}, "`cond` beside `guard` is left out"),
        ({"on": {"E": {"target": "a", "in": "b.c"}}}, "`in`: the state `b.c` does not exist"),
        ({"initial": "x"}, "`initial` is left out: the state has no inner states"),
        ({"parallel": "yes"}, "`parallel` can't be `yes`"),
        ({"type": "Parallel", "states": {"x": {}}}, "unknown type of state `Parallel`"),
        ({"type": "parallel", "initial": "x", "states": {"x": {}, "y": {}}},
         "`initial` of a parallel state: it enters all of its states"),
        ({"initial": "x", "states": {"x": {}, "h": {"type": "history", "history": "Deep"}}},
         "`history` can't be `Deep`"),
        ({"initial": "x", "states": {"x": {}, "h": {"type": "history", "on": {"E": "x"}}}},
         "`on` of a history state has no counterpart in Lumen"),
        ({"invoke": {"src": "x", "input": {"n": 1}}}, "`input` of the `invoke` is left out"),
        ({"meta": {"lumen": {"resume": "soon"}}}, "`resume` of `meta.lumen` has no counterpart in Lumen"),
        ({"description": ["x"]}, "`description` is not a string"),
        ({"invoke": {"src": "x", "id": 3}}, "`id` is not a string"),
        ({"invoke": [None]}, "this is not an invocation"),
        ({"invoke": {"src": {"type": "x", "pace": 3}}}, '`invoke` of `x {"pace": 3}`: its code is not in the file'),
        ({"type": "final", "output": 1, "data": 2}, "`data` beside `output` is left out"),
        ({"on": {" *": "b"}}, "the events ` *` are renamed to `*`"),
        ({"on": {"E": {"target": ["a", "b"]}}}, "`a` and `b` can't be active together"),
        ({"states": {"h": {"type": "history"}}, "on": {"E": ".h"}}, "there is no state `.h` to go to"),
        ({"initial": "h", "states": {"h": {"history": True}, "x": {}}},
         "this history leads to a history, the first state of its parent"),
        ({"initial": "x", "states": {"h": {"history": True}, "i": {"type": "history", "target": "h"}, "x": {}}},
         "a history can't lead to a history"),
    ],
)  # fmt: skip
def test_unread_keys_of_a_machine_are_listed(state: dict[str, Any], found: str) -> None:
    said = xstate({"initial": "a", "states": {"a": state, "b": {}}})[1]
    assert found in [d.message for d in said], messages(said)


def test_a_key_that_is_assigned_values_of_two_kinds_may_hold_both() -> None:
    entry = {"type": "xstate.assign", "assignment": {"n": "one"}}
    data, found = xstate({"context": {"n": 0}, "states": {"a": {"entry": entry}}})
    assert (data["types"], found) == ({"n": {}}, [])
    it = Interpreter(Machine.from_dict(data))
    assert it.start().snapshot.context == {"n": "one"}


def test_an_event_with_a_blank_has_one_name() -> None:
    data, found = xstate("event-with-blank.json")
    assert [d.message for d in found] == [
        "the event `menu shown` is renamed to `menu_shown` in the whole behaviour",
        "the event `say hello` is renamed to `say_hello` in the whole behaviour",
    ]
    it = Interpreter(Machine.from_dict(data))
    it.start()
    assert set(it.configuration) == {"b"}
    it.clock.advance(1.0)
    assert set(it.configuration) == {"c"}


def test_names_that_only_clash_after_cleaning_stay_two() -> None:
    chart = {"initial": "a", "states": {
        "a": {"invoke": [{"id": "my clock", "src": "x", "onDone": "b"}, {"id": "my_clock", "src": "y", "onDone": "c"}],
              "on": {"say it": "b", "say_it": "c"}, "entry": {"type": "xstate.raise", "event": "say it"}},
        "b": {"id": "x y"}, "c": {"id": "x_y"}}}  # fmt: skip
    data, _ = xstate(chart)
    assert data["states"]["a"]["on"] == {
        "say_it_2": "b",
        "say_it": "c",
        "done.invoke.my_clock_2": "b",
        "done.invoke.my_clock": "c",
    }
    assert data["states"]["a"]["entry"] == [{"raise": "say_it_2"}]
    assert [data["states"][key]["id"] for key in "bc"] == ["x_y_2", "x_y"]


def test_a_key_that_is_there_twice_is_listed() -> None:
    content = b'{"initial": "a", "states": {"a": {"on": {"E": "a", "E": "b"}}, "b": {}}}'
    _, found = read_xstate("chart.json", content, "chart")
    assert messages(found) == [
        "1:52 `E` is written twice in the same place (only the last one is used: delete the others)"
    ]


def changed_json(data: Any, where: tuple[Any, ...] = ()) -> Iterator[tuple[str, Any]]:
    """Yield the path of each key with data in which it is removed, renamed or has another value."""
    for key, value in data.items() if isinstance(data, dict) else enumerate(data) if isinstance(data, list) else ():
        path = ".".join(map(str, (*where, key)))
        others = {k: v for k, v in data.items() if k != key} if isinstance(data, dict) else None
        if others is not None:
            yield path, others
            yield path, {**others, f"{key}x": value}
        if isinstance(value, bool | int | str):
            new = (not value) if isinstance(value, bool) else value + 1 if isinstance(value, int) else f"{value}q"
            yield path, data | {key: new} if isinstance(data, dict) else [*data[:key], new, *data[key + 1 :]]
        for below, changed in changed_json(value, (*where, key)):
            yield below, data | {key: changed} if isinstance(data, dict) else [*data[:key], changed, *data[key + 1 :]]


@for_each(
    ("name", "meaningless"),
    [
        # explicit defaults, keys without meaning, and parts of something that is listed as lost
        ("rich4.json", {"id", "key", "predictableActionArguments", "initial", "states.b.initial",
                        "states.b.invoke.data.n", "states.b.invoke.autoForward", "states.b.states.was.type",
                        "states.b.states.was.target"}),
        ("rich5.json", {"states.a.tags.0", "states.a.on.say it.reenter", "states.b.initial", "states.b.invoke.input.n",
                        "states.z.meta.note"}),
    ],
)  # fmt: skip
def test_no_change_of_a_key_is_silent(name: str, meaningless: set[str]) -> None:
    def read(data: Any) -> Any:
        try:
            result, found = read_xstate(name, json.dumps(data).encode(), "chart")
        except ForeignFileError as error:
            return str(error.diagnostic)
        return json.dumps(result), sorted((d.message, d.hint) for d in found)

    machine = json.loads((INPUTS / name).read_bytes())
    before = read(machine)
    assert {path for path, changed in changed_json(machine) if read(changed) == before} == meaningless
