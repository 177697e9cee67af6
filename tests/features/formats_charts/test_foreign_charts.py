"""Charts that other people wrote for XState: once imported, they reach the states that XState reaches."""

import json
from typing import Any

from lumen.features.formats_charts.xstate import read_xstate
from lumen.language.diagnostics import has_errors
from lumen.statechart import Interpreter, Machine
from tests.features.formats_charts.test_xstate_runs import by_xstate
from tests.tables import for_each

FINAL: dict[str, Any] = {"type": "final"}
LOADING = {
    "id": "loader",
    "initial": "idle",
    "states": {
        "idle": {"on": {"FETCH": "busy"}},
        "busy": {
            "invoke": {"src": "fetchAll", "onDone": "shown", "onError": {"target": "failed"}},
            "on": {"CANCEL": "idle"},
        },
        "shown": {"invoke": {"id": "watch.er", "src": "watcher", "onDone": "idle"}},
        "failed": {"on": {"RETRY": "busy", "*": "idle"}},
    },
}


def remembering(history: dict[str, Any], **more: Any) -> dict[str, Any]:
    return {
        "initial": "off",
        "states": {
            "off": {"on": {"POWER": "on.back", "ALL": "on"}},
            "on": {
                "initial": "cold",
                "states": {
                    "cold": {"on": {"NEXT": "warm"}},
                    "warm": {"initial": "low", "states": {"low": {"on": {"NEXT": "high"}}, "high": {}}},
                    "back": history,
                },
                "on": {"POWER": "off"},
                **more,
            },
        },
    }


REMEMBERED = ["POWER", "NEXT", "NEXT", "POWER", "POWER", "NEXT", "POWER", "ALL"]
STRANGERS: dict[str, tuple[dict[str, Any], list[str]]] = {
    "history true": (remembering({"history": True}), REMEMBERED),
    "history shallow": (remembering({"history": "shallow"}), REMEMBERED),
    "history deep": (remembering({"history": "deep"}), REMEMBERED),
    "type history": (remembering({"type": "history"}), REMEMBERED),
    "type and true": (remembering({"type": "history", "history": True, "target": "warm"}), REMEMBERED),
    "deep with a target": (remembering({"history": "deep", "target": "warm"}), REMEMBERED),
    "a target by its path": (remembering({"history": True, "target": "warm.high"}), REMEMBERED),
    "initial as an object": (remembering({"history": True}, initial={"target": "warm"}), REMEMBERED),
    "history of regions": (
        {
            "initial": "off",
            "states": {
                "off": {"on": {"GO": "both.hist"}},
                "both": {
                    "type": "parallel",
                    "states": {
                        "a": {"initial": "x", "states": {"x": {"on": {"A": "y"}}, "y": {}}},
                        "b": {"initial": "x", "states": {"x": {"on": {"B": "y"}}, "y": {}}},
                        "hist": {"history": "deep"},
                    },
                    "on": {"STOP": "off"},
                },
            },
        },
        ["GO", "A", "STOP", "GO", "B", "STOP", "GO"],
    ),
    "an actor that ends": (LOADING, ["FETCH", "xstate.done.actor.0.loader.busy", "xstate.done.actor.watch.er"]),
    "an actor that fails": (LOADING, ["FETCH", "xstate.error.actor.0.loader.busy", "RETRY", "CANCEL"]),
    "two actors, one without an id": (
        {
            "initial": "a",
            "states": {
                "a": {
                    "invoke": [{"id": "first", "src": "x"}, {"src": "y", "onDone": "b"}],
                    "on": {"xstate.done.actor.first": "c"},
                },
                "b": {"on": {"BACK": "a"}},
                "c": {},
            },
        },
        ["xstate.done.actor.1.(machine).a", "BACK", "xstate.done.actor.first"],
    ),
    "a final state as a region": (
        {
            "initial": "both",
            "states": {
                "both": {
                    "type": "parallel",
                    "states": {
                        "l": {"initial": "a", "states": {"a": {"on": {"E": "z"}}, "z": FINAL}},
                        "there": {"type": "final", "entry": "cheer"},
                        "in": {"type": "parallel", "states": {"x": FINAL, "y": FINAL}},
                    },
                    "onDone": "over",
                },
                "over": {},
            },
        },
        ["F", "E"],
    ),
    "the end of a state by XState's name": (
        {
            "id": "m",
            "initial": "a",
            "on": {"xstate.done.state.m.a": ".over"},
            "states": {"a": {"initial": "b", "states": {"b": {"on": {"E": "c"}}, "c": FINAL}}, "over": {}},
        },
        ["E"],
    ),
}


def read(chart: dict[str, Any]) -> tuple[dict[str, Any], list[Any]]:
    return read_xstate("chart.json", json.dumps(chart).encode(), "chart")


def ours(event: str) -> str:
    return event.replace("xstate.done.actor.", "done.invoke.").replace("xstate.error.actor.", "error.invoke.")


def way(machine: Machine, events: list[str]) -> list[list[str]]:
    """Return the paths of the active states at first and after each event."""
    paths = {state.name: path for path, state in machine.states.items() if path and not path.endswith(".ended")}
    it = Interpreter(machine)
    it.start()
    seen = [sorted(paths[name] for name in it.configuration if name in paths)]
    for event in events:
        it.send(ours(event))
        seen.append(sorted(paths[name] for name in it.configuration if name in paths))
    return seen


def test_strangers_go_where_xstate_goes() -> None:
    found = by_xstate([{"config": chart, "events": events} for chart, events in STRANGERS.values()])
    for (title, (chart, events)), seen in zip(STRANGERS.items(), found, strict=True):
        machine = Machine.from_dict(read(chart)[0])
        assert way(machine, events) == [sorted(states) for states, _ in seen], title


def test_a_history_is_no_loss() -> None:
    for title in ("history true", "deep with a target", "initial as an object"):
        assert read(STRANGERS[title][0])[1] == []


def test_what_an_actor_did_is_told_and_its_end_waited_for() -> None:
    data, said = read(LOADING)
    assert data["states"]["busy"]["on"] == {
        "CANCEL": "idle",
        "done.invoke.0.loader.busy": "shown",
        "error.invoke.0.loader.busy": "failed",
    }
    assert [d.message for d in said] == [
        "`invoke` of `fetchAll`: its code is not in the file",
        "`invoke` of `watcher`: its code is not in the file",
    ]
    assert all("invoke a behaviour with the id `" in d.hint for d in said)
    assert all(d.place.line for d in said)
    assert has_errors(said)


def test_a_behaviour_invoked_by_that_id_is_what_is_waited_for() -> None:
    """After the change that the hint suggests, the machine works again."""
    data, _ = read(LOADING)
    data["states"]["shown"]["invoke"] = {"behavior": "watcher", "id": "watch.er"}
    watcher = {"initial": "a", "states": {"a": {"on": {"END": "z"}}, "z": FINAL}}
    machine = Machine.from_dict(data, behaviors={"watcher": watcher})
    assert way(machine, ["FETCH", "xstate.done.actor.0.loader.busy", "END"])[-1] == ["idle"]


@for_each(
    ("state", "message"),
    [
        ({"type": "final", "on": {"E": "b"}}, "`on` of a final state: nothing follows a final state"),
        ({"type": "final", "invoke": {"src": "x"}}, "`invoke` of a final state: nothing follows a final state"),
        ({"type": "blue"}, "unknown type of state `blue`"),
        ({"on": "E"}, "`on` is not an object"),
        ({"on": [{"target": "b"}]}, "this is not a transition: it has no `event`"),
        ({"after": [{"target": "b"}]}, "this is not a transition: it has no `delay`"),
        ({"on": {"xstate.snapshot.x": "b"}}, "Lumen never raises `xstate.snapshot.x`"),
        ({"invoke": {"src": "x", "onSnapshot": "b"}}, "`onSnapshot`: a behaviour reports only its end"),
    ],
)
def test_nothing_is_left_out_in_silence(state: dict[str, Any], message: str) -> None:
    _, said = read({"initial": "a", "states": {"a": state, "b": {}}})
    assert message in [d.message for d in said]
    assert has_errors(said)


def test_the_words_of_version_4() -> None:
    chart = {
        "initial": "a",
        "states": {
            "a": {"on": {"": {"target": "b", "cond": "ready"}, "E": {"target": "a", "internal": False}}, "entry": "in"},
            "b": {"parallel": True, "states": {"x": {}, "y": {"invoke": "clock"}}},
        },
    }
    data, said = read(chart)
    assert data["states"]["a"]["always"] == {"guard": "context.ready", "target": "b"}
    assert data["states"]["a"]["on"] == {"E": "a"}
    assert data["states"]["b"]["type"] == "parallel"
    assert "`invoke` of `clock`: its code is not in the file" in [d.message for d in said]
    assert Machine.from_dict(data)
