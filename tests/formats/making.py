"""Random machines with every element that formats must carry, and events for them."""

from contextlib import suppress
from typing import Any

from hypothesis import strategies as st

from lumen.errors import LumenError
from lumen.language.events import Event
from lumen.statechart import Machine, Snapshot, Step, due, initial, step

EVENTS = ["e", "f", "f.g", "f.g.h"]
DESCRIPTORS = [*EVENTS, "f.*", "*", "done.state.a", "error"]
ACTIONS: list[dict[str, Any]] = [
    {"assign": {"n": "context.n + 1", "t": "'f'"}},
    {"assign": {"t": "event.name"}},
    {"assign": {"list": "[context.n, 'x']"}},
    {"assign": {"wide": "context.n > 2 ? 'much' : 1.5"}},
    {"assign": {"n": "event.data.nothing"}},
    {"raise": "f"},
    {"raise": {"event": "f.g", "data": {"x": "context.n % 2 == 0", "deep": [1, {"y": "'text'"}]}}},
    {"send": {"event": "e", "delay": "300ms", "id": "one", "data": "context.t"}},
    {"send": {"event": "f.g.h", "delay": "1.5s"}},
    {"send": {"event": "e", "to": "parent", "data": {"n": "context.t"}}},
    {"cancel": "one"},
    {"log": "{{ context.n }} of {{ context.t }}{{ '{{' }}"},
    {"say": {"any": ["x", "y's"]}},
    {"track": {"head": True}},
    {"if": "context.n > 2", "then": [{"play": "p"}], "else": [{"if": "In('a')", "then": [{"log": "few"}]}]},
]
SAFE = [action for action in ACTIONS if action != {"assign": {"n": "event.data.nothing"}}]
DEEDS = [*ACTIONS, {"wait": "200ms"}, {"parallel": [{"say": "x"}, {"wait": "100ms"}]}]
GUARDS = [
    "context.n % 2 == 0",
    "has(event.data.x) && event.data.x == true",
    "!In('a') || context.n / 2 > 1",
    "contains(context.t, 'f') && size(context.list) != 3",
    "context.n in context.list || 'x' in context.list",
    "matches(event.name, r'^f\\.') ? context.n < 5 : context.wide != null",
    "context.list == [1, 'x'] || heard(context.t, 'word')",
]


@st.composite
def charts(draw: st.DrawFn, *, deep: bool = True) -> dict[str, Any]:
    """Draw the data of a machine of at most three levels, some states with ids, and no endless `always`; `deep` allows
    `initial` to lead deeper than to a child, and actions of transitions to fail."""
    tree = draw(
        st.recursive(st.just({}), lambda t: st.dictionaries(st.sampled_from("abc"), t, min_size=1), max_leaves=8)
    )
    names: list[str] = []
    root = _state(draw, {"a": {}} | tree, "", names)
    root["id"] = draw(st.sampled_from(["chart", "my.chart"]))
    root["context"] = {"n": 0, "t": "", "list": [], "wide": None}
    root["phrases"] = {"word": {"en": ["f"]}}
    _fill(draw, root, names if deep else [], "", names)
    return root


def _state(draw: st.DrawFn, children: dict[str, Any], path: str, names: list[str]) -> dict[str, Any]:
    data: dict[str, Any] = {}
    if path and draw(st.booleans()):
        data["id"] = f"id{len(names)}"
    if path:
        names.append(data.get("id", path))
    if children:
        data["type"] = draw(st.sampled_from(["compound", "parallel"]))
        below = f"{path}." if path else ""
        data["states"] = {key: _state(draw, child, below + key, names) for key, child in children.items()}
        if draw(st.booleans()):
            data["states"]["h"] = {"type": "history", "history": draw(st.sampled_from(["shallow", "deep"]))}
            names.append(f"{below}h")
        if data["type"] == "compound" and draw(st.booleans()):
            data["states"]["z"] = {"type": "final", "output": {"n": "context.n", "s": "'done'"}}
    elif draw(st.booleans()):
        data["do"] = []
    return data


def _fill(draw: st.DrawFn, data: dict[str, Any], deeper: list[str], path: str, names: list[str]) -> None:
    if data.get("type") in ("history", "final"):
        return
    for key in ("entry", "exit"):
        if found := draw(st.lists(st.sampled_from(ACTIONS), max_size=2)):
            data[key] = found
    targets = st.sampled_from(names).map(lambda name: f"#{name}")
    rows = st.fixed_dictionaries(
        {},
        optional={
            "target": targets,
            "reenter": st.booleans(),
            "guard": st.sampled_from(GUARDS),
            "actions": st.lists(st.sampled_from(ACTIONS if deeper else SAFE), max_size=1),
        },
    )
    several = st.lists(rows, min_size=1, max_size=2)
    on = draw(st.dictionaries(st.sampled_from(DESCRIPTORS), several, max_size=3))
    after = draw(st.dictionaries(st.sampled_from(["100ms", "1.5s", "2min"]), rows, max_size=1))
    data.update({key: table for key, table in (("on", on), ("after", after)) if table})
    if "do" in data:
        data["do"] = draw(st.lists(st.sampled_from(DEEDS), min_size=1, max_size=3))
        data["onError"] = draw(several)
    if "do" in data or "states" in data:
        data["onDone"] = draw(several)
    _begin(draw, data, deeper, path)
    for key, child in data.get("states", {}).items():
        _fill(draw, child, deeper, f"{path}.{key}" if path else key, names)


def _begin(draw: st.DrawFn, data: dict[str, Any], names: list[str], path: str) -> None:
    """Sometimes let a compound state begin deep inside."""
    if data.get("type") != "compound":
        return
    keys = [key for key, child in data["states"].items() if child.get("type") not in ("history", "final")]
    deeper = [
        f"#{path}.{key}.{inner}".replace("#.", "#") for key in keys for inner in data["states"][key].get("states", {})
    ]
    known = [text for text in deeper if text[1:] in names and not text.endswith(".h")]
    data["initial"] = draw(st.sampled_from([*keys, *known]))


HAPPENINGS = st.lists(st.sampled_from([*EVENTS, "tick", "answer", "refuse"]), max_size=10)


def run(machine: Machine, happenings: list[str]) -> list[Step]:
    """Return the steps until the end, or until the machine does not come to rest any more."""
    steps: list[Step] = []
    with suppress(LumenError):
        steps.append(initial(machine))
        for what in happenings:
            steps.append(step(machine, steps[-1].snapshot, _happen(steps[-1].snapshot, what)))
    return steps


def _happen(snapshot: Snapshot, what: str) -> Event:
    if what == "tick":
        return due(snapshot) or Event("e", None, snapshot.at)
    if what in ("answer", "refuse"):
        kind = "done" if what == "answer" else "error"
        return Event(f"{kind}.command.d{snapshot.counters.awaited}", None, snapshot.at)
    return Event(what, {"x": True}, snapshot.at + 0.05)
