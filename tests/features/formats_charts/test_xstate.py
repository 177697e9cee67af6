"""The import of each part of an XState machine, and the reports for code outside the file."""

import json
from typing import Any

from lumen.features.formats_charts.xstate import read_xstate, write_xstate
from lumen.project.formats.conversion_findings import dotted
from lumen.statechart import Machine, initial


def read(chart: dict[str, Any]) -> tuple[dict[str, Any], list[str]]:
    """Return the data, and the line and message of each finding."""
    data, diagnostics = read_xstate("chart.json", json.dumps(chart, indent=1).encode(), "chart")
    Machine.from_dict(data)
    return data, [f"{d.place.line}: {d.message}" for d in diagnostics]


def test_a_machine_as_it_is_written_for_xstate() -> None:
    data, said = read(
        {
            "id": "light",
            "context": {"count": 0},
            "initial": "green",
            "states": {
                "green": {"on": {"TIMER": "yellow", "SELF": {"target": "green"}}, "after": {"1500": "yellow"}},
                "yellow": {"on": {"*": {"target": "Very red"}, "TIMER": {"target": "#light.Very red.stop"}}},
                "Very red": {
                    "id": "red",
                    "initial": "walk",
                    "states": {"walk": {"always": "stop"}, "stop": {"type": "final"}},
                    "onDone": "green",
                },
            },
        }
    )
    assert said == []
    assert data["states"] == {
        "green": {"on": {"TIMER": "yellow", "SELF": {}}, "after": {"1.5s": "yellow"}},
        "yellow": {"on": {"TIMER": "#Very_red.stop", "*": "Very_red"}},
        "Very_red": {
            "id": "red",
            "initial": "walk",
            "onDone": "green",
            "states": {"walk": {"always": "stop"}, "stop": {"type": "final"}},
        },
    }


def test_a_note_for_readers_is_left_out_without_a_word() -> None:
    states = {"a": {"on": {"go": {"target": "b", "description": "A visitor comes."}}}, "b": {}}
    data, said = read({"id": "m", "states": states})
    assert (data["states"]["a"], said) == ({"on": {"go": "b"}}, [])


def test_code_that_is_not_in_the_file() -> None:
    data, said = read(
        {
            "id": "m",
            "states": {
                "a": {
                    "entry": ["ring", {"type": "xstate.raise", "event": {"type": "E"}}],
                    "on": {"E": {"target": "a", "guard": "isOpen", "reenter": True}},
                    "after": {"soon": "a"},
                    "invoke": {"src": "fetch"},
                    "tags": ["busy"],
                }
            },
        }
    )
    assert data["context"] == {"isOpen": False}
    assert data["states"]["a"]["entry"] == [{"log": "ring"}, {"raise": "E"}]
    assert data["states"]["a"]["on"] == {"E": {"guard": "context.isOpen", "target": "a"}}
    assert [message.partition(": ")[2] for message in said] == [
        "the code of the action `ring` is not in the file",
        "the code of the guard `isOpen` is not in the file",
        "the code of the delay `soon` is not in the file",
        "`invoke` of `fetch`: its code is not in the file",
        "`tags` are left out",
    ]
    lines = [int(message.partition(": ")[0]) for message in said]
    assert lines == sorted(set(lines))


def test_what_goes_to_other_actors() -> None:
    sent = [
        {"type": "xstate.sendTo", "to": "#_parent", "event": {"type": "E"}},
        {"type": "xstate.sendTo", "to": "my quiz", "event": {"type": "E"}, "delay": 2000, "id": "x"},
        {"type": "xstate.send", "to": "#_quiz", "event": {"type": "E"}},
        {"type": "xstate.sendTo", "to": "quiz", "event": {"type": "E", "answer": 42}},
        {"type": "xstate.sendTo", "event": {"type": "E"}},
    ]
    data, said = read({"id": "m", "states": {"a": {"entry": sent}}})
    assert data["states"]["a"]["entry"][:4] == [
        {"send": {"event": "E", "to": "parent"}},
        {"send": {"event": "E", "delay": "2s", "id": "x", "to": "my_quiz"}},
        {"send": {"event": "E", "to": "quiz"}},
        {"send": {"event": "E", "data": {"answer": 42}, "to": "quiz"}},
    ]
    assert [message.partition(": ")[2] for message in said] == ["`xstate.sendTo`: its recipient is not in the file"]


def test_order_and_prefixes_survive_xstates_rules() -> None:
    chart = {
        "id": "m",
        "context": {"n": 0},
        "states": {
            "a": {
                "entry": {"raise": "door.open"},
                "on": {
                    "*": {"guard": "context.n > 1", "target": "b"},
                    "door": "b",
                    "a": {"reenter": True, "target": "a"},
                },
            },
            "b": None,
        },
    }
    config = json.loads(write_xstate(Machine.from_dict(chart), dotted("m"))[0])
    star = {"target": "b", "guard": {"type": "lumen.expression", "params": {"source": "context.n > 1"}}}
    assert config["states"]["a"]["on"] == {
        "door.*": [star, {"target": "b"}],
        "a": [star, {"target": "a", "reenter": True}],
        "*": [star],
    }


def test_an_initial_state_deep_inside() -> None:
    chart = {"id": "m", "initial": "#a.b", "states": {"a": {"initial": "c", "states": {"c": None, "b": None}}}}
    text, said = write_xstate(Machine.from_dict(chart), dotted("m"))
    assert [d.message for d in said] == [
        "XState's `initial` must be a child: the additional state `begin` leads to the inner state"
    ]
    again = Machine.from_dict(read_xstate("m", text.encode(), "m")[0])
    assert initial(again).snapshot.configuration == {"a", "a.b"}
