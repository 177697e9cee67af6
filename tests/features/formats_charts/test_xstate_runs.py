"""XState itself, on Node, runs what we export: the same states and the same context after the same events."""

import json
from pathlib import Path
from typing import Any

from lumen.features.formats_charts.xstate import write_xstate
from lumen.project.formats.conversion_findings import dotted
from lumen.statechart import Interpreter, Machine, VirtualClock
from tests import ROOT
from tests.fetched import fetched
from tests.guarded import run_guarded
from tests.waiting import HANG

CHARTS: list[tuple[dict[str, Any], list[Any]]] = [
    (  # nested states, the first child's way, an inner one before an outer one
        {
            "initial": "a",
            "on": {"out": ".b"},
            "states": {
                "a": {"initial": "x", "on": {"go": "b"}, "states": {"x": {"on": {"go": "y"}}, "y": {}}},
                "b": {"initial": "deep", "states": {"deep": {"on": {"out": {}}}}},
            },
        },
        ["go", "go", "out", "nothing"],
    ),
    (  # regions, and what comes when both have ended
        {
            "initial": "both",
            "states": {
                "both": {
                    "type": "parallel",
                    "states": {
                        "l": {"initial": "a", "states": {"a": {"on": {"e": "z"}}, "z": {"type": "final"}}},
                        "r": {"initial": "a", "states": {"a": {"on": {"f": "z"}}, "z": {"type": "final"}}},
                    },
                    "onDone": "over",
                },
                "over": {},
            },
        },
        ["e", "e", "f"],
    ),
    (  # history, shallow and deep
        {
            "initial": "p",
            "on": {"leave": ".away", "shallow": ".p.s", "deep": ".p.d"},
            "states": {
                "p": {
                    "initial": "one",
                    "states": {
                        "one": {"on": {"next": "two"}},
                        "two": {"initial": "i", "states": {"i": {"on": {"next": "j"}}, "j": {}}},
                        "s": {"type": "history", "target": "one"},
                        "d": {"type": "history", "history": "deep", "target": "one"},
                    },
                },
                "away": {},
            },
        },
        ["next", "next", "leave", "shallow", "next", "leave", "deep"],
    ),
    (  # guards in order, assignments in entry, exit and on the way, re-entering, internal transitions, always
        {
            "context": {"n": 0, "in": 0},
            "initial": "a",
            "states": {
                "a": {
                    "entry": {"assign": {"in": "context.in + 1"}},
                    "initial": "k",
                    "states": {"k": {"on": {"up": "l"}}, "l": {}},
                    "on": {
                        "up": {"actions": {"assign": {"n": "context.n + 10"}}},
                        "stay": ".k",
                        "again": {"target": ".k", "reenter": True},
                        "go": [
                            {"guard": "context.n > 15", "target": "b"},
                            {"actions": {"assign": {"n": "context.n + 1"}}},
                        ],
                    },
                },
                "b": {"exit": {"assign": {"n": "0"}}, "always": {"guard": "context.in > 1", "target": "c"}},
                "c": {"on": {"back": "a"}},
            },
        },
        ["up", "go", "up", "stay", "again", "up", "up", "go", "back"],
    ),
    (  # descriptors: a prefix, all, the longest first, and what is forbidden
        {
            "context": {"said": ""},
            "events": {"window.open": None},
            "initial": "a",
            "states": {
                "a": {
                    "on": {
                        "door.open": {"actions": {"assign": {"said": "'open'"}}},
                        "door.*": {"actions": {"assign": {"said": "'door'"}}},
                        "window": {"actions": {"assign": {"said": "'window'"}}},
                        "*": {"actions": {"assign": {"said": "'else'"}}},
                    }
                }
            },
        },
        ["door.open", "door.shut.hard", "window", "window.open", "bell", "door"],
    ),
    (  # timers, and a raised event
        {
            "initial": "a",
            "states": {
                "a": {"after": {"2s": "b", "1s": {"guard": "false", "target": "c"}}, "on": {"now": "c"}},
                "b": {"after": {"500ms": "c"}},
                "c": {"entry": {"raise": "ping"}, "on": {"ping": "d"}},
                "d": {"on": {"back": "a"}},
            },
        },
        [1.5, 0.5, 0.4, 0.2, "back", 1.0, "now", 5.0],
    ),
]


def by_xstate(rows: list[dict[str, Any]]) -> Any:
    script = Path(__file__).with_name("xstate.mjs")
    command = ["node", str(script), (fetched("xstate") / "dist" / "xstate.esm.js").as_uri()]
    run = run_guarded(command, input=json.dumps(rows), capture_output=True, text=True, timeout=HANG, check=False)
    assert run.returncode == 0, run.stderr
    return json.loads(run.stdout)


def exported(machine: Machine) -> Any:
    return json.loads(write_xstate(machine, dotted("machine"))[0])


def by_lumen(machine: Machine, events: list[Any]) -> Any:
    clock = VirtualClock()
    it = Interpreter(machine, clock=clock)
    it.start()
    seen = [[sorted(it.configuration), it.context]]
    for event in events:
        if isinstance(event, float):
            clock.advance(event)
        else:
            it.send(event, {})
        seen.append([sorted(it.configuration), it.context])
    return json.loads(json.dumps(seen))


def test_xstate_goes_the_same_way() -> None:
    machines = [Machine.from_dict(chart) for chart, _ in CHARTS]
    rows = [
        {"config": exported(machine), "events": [e * 1000 if isinstance(e, float) else e for e in events]}
        for machine, (_, events) in zip(machines, CHARTS, strict=True)
    ]
    found = by_xstate(rows)
    for machine, (chart, events), seen in zip(machines, CHARTS, found, strict=True):
        expected = by_lumen(machine, events)
        states = [names for names, _ in seen]
        assert states == [names for names, _ in expected], chart
        if machine.context:
            assert [context for _, context in seen] == [context for _, context in expected], chart


def test_xstate_enters_the_tour_where_we_do() -> None:
    machine = Machine.load(ROOT / "behaviors/tour.yaml")
    [[[states, context]]] = by_xstate([{"config": exported(machine), "events": []}])
    active = Interpreter(machine)
    active.start()
    paths = {path for path, state in machine.states.items() if state.name in active.configuration}
    assert set(states) == paths
    assert context == machine.context
