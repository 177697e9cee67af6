"""Laws of every machine: the same events give the same steps, and a snapshot on the disk loses nothing."""

import json
from collections.abc import Iterator
from contextlib import suppress
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lumen.errors import LumenError
from lumen.language.commands import Cancel, Start
from lumen.language.events import Event
from lumen.language.machines import StateKind
from lumen.statechart import Machine, Snapshot, Step, deserialize, due, initial, serialize, step
from lumen.statechart.values import awaited

EVENTS = ["e", "f", "g.h"]
ACTIONS: list[dict[str, Any]] = [
    {"assign": {"n": "context.n + 1"}},
    {"assign": {"n": "event.data.nothing"}},
    {"raise": "f"},
    {"send": {"event": "g.h", "delay": "300ms", "id": "one"}},
    {"cancel": "one"},
    {"log": "{{ context.n }}"},
    {"say": {"any": ["x", "y", "z"]}},
    {"if": "context.n > 2", "then": [{"play": "p"}], "else": [{"log": "few"}]},
]
DEEDS: list[dict[str, Any]] = [
    *ACTIONS,
    {"wait": "200ms"},
    {"parallel": [{"say": "x"}, {"wait": "100ms"}, {"if": "true", "then": [{"play": "p"}, {"wait": "100ms"}]}]},
]


@st.composite
def trees(draw: st.DrawFn, invokes: list[str]) -> dict[str, Any]:
    """Draw a random behaviour: at most three levels, any target, no endless `always`; states may invoke `invokes`."""
    tree = draw(
        st.recursive(st.just({}), lambda t: st.dictionaries(st.sampled_from("abc"), t, min_size=1), max_leaves=8)
    )
    names: list[str] = []

    def state(children: dict[str, Any], depth: int) -> dict[str, Any]:
        names.append(id := f"n{len(names)}")
        data: dict[str, Any] = {"id": id}
        if children:
            data["type"] = draw(st.sampled_from(["compound", "parallel"]))
            data["states"] = {key: state(child, depth + 1) for key, child in children.items()}
            if draw(st.booleans()):
                data["states"]["h"] = {
                    "type": "history",
                    "history": draw(st.sampled_from(["shallow", "deep"])),
                    "id": id + "h",
                }
                names.append(id + "h")
        return data

    root = state(tree or {"a": {}}, 0)
    root["context"] = {"n": 0}

    def fill(data: dict[str, Any]) -> None:
        if data.get("type") == "history":
            return
        for key in ("entry", "exit"):
            data[key] = draw(st.lists(st.sampled_from(ACTIONS), max_size=2))
        data["do"] = draw(st.lists(st.sampled_from(DEEDS), max_size=3))
        targets = st.sampled_from(names).map(lambda name: f"#{name}")
        guards = st.sampled_from(["true", "context.n % 2 == 0", "event.data.x"])
        rows = st.fixed_dictionaries({"target": targets, "reenter": st.booleans(), "guard": guards})
        data["on"] = draw(st.dictionaries(st.sampled_from([*EVENTS, "*"]), rows, max_size=2))
        data["after"] = draw(st.dictionaries(st.sampled_from(["100ms", "1s"]), rows, max_size=1))
        if invokes and draw(st.booleans()):
            called = {"id": f"q{data['id']}", "behavior": draw(st.sampled_from(invokes))}
            ends = {"onDone": draw(st.lists(rows, max_size=1)), "onError": draw(st.lists(rows, max_size=1))}
            data["invoke"] = {**called, "input": {"n": "context.n + 2"}, **ends}
        for child in data.get("states", {}).values():
            fill(child)

    fill(root)
    if not invokes or draw(st.booleans()):
        end = draw(st.sampled_from(EVENTS))
        root = {"context": {"n": 0}, "states": {"s": {**root, "on": {**root["on"], end: "f"}}, "f": {"type": "final"}}}
        root["states"]["s"].pop("context")
    return root


@st.composite
def machines(draw: st.DrawFn) -> Machine:
    """Return a random machine that may invoke others, which may invoke a third."""
    inner = draw(trees([]))
    outer = draw(trees(["inner"]))
    return Machine.from_dict(draw(trees(["inner", "outer"])), behaviors={"inner": inner, "outer": outer})


HAPPENINGS = st.lists(st.sampled_from([*EVENTS, "g", "tick", "answer", "refuse"]), max_size=12)


def last_awaited(snapshot: Snapshot) -> str:
    """Return the id of the command that a `do` began to await last, in any running behaviour; empty if none waits."""
    ids = [id for position in snapshot.doing.values() for id in awaited(position) if id.startswith("d")]
    ids += [f"{id}@{owner}" for owner, c in snapshot.invoked.items() if (id := last_awaited(c.snapshot))]
    return max(ids, key=lambda id: int(id[1:].partition("@")[0]), default="")


def running(machine: Machine, snapshot: Snapshot) -> Iterator[tuple[Machine, Snapshot]]:
    """Yield the machine and all machines that it has invoked, each with its snapshot."""
    yield machine, snapshot
    for id, child in snapshot.invoked.items():
        [name] = [invoke.behavior for invoke in machine.states[child.state].invoke if invoke.id == id]
        yield from running(machine.invoked[name], child.snapshot)


def happen(snapshot: Snapshot, what: str) -> Event:
    """Return the event of a happening in this snapshot: the next timer, or an answer to the last awaited command."""
    if what == "tick":
        return due(snapshot) or Event("e", None, snapshot.at)
    if what in ("answer", "refuse"):
        kind = "done" if what == "answer" else "error"
        return Event(f"{kind}.command.{last_awaited(snapshot) or 'd1'}", None, snapshot.at)
    return Event(what, {"x": True}, snapshot.at + 0.05)


def run(machine: Machine, happenings: list[str], *, through_disk: bool = False) -> list[Step]:
    """Return the steps until the end, or until the machine does not come to rest any more."""
    steps: list[Step] = []
    with suppress(LumenError):
        steps.append(initial(machine))
        for what in happenings:
            steps.append(next_step(machine, steps[-1].snapshot, what, through_disk))
    return steps


def next_step(machine: Machine, snapshot: Snapshot, what: str, through_disk: bool) -> Step:
    if through_disk:
        snapshot = deserialize(machine, json.loads(json.dumps(serialize(machine, snapshot))))
    return step(machine, snapshot, happen(snapshot, what))


@pytest.mark.slow
@settings(max_examples=25, deadline=None)
@given(machines(), HAPPENINGS)
def test_a_run_keeps_the_laws(machine: Machine, happenings: list[str]) -> None:
    keeps_the_laws(machine, happenings)


@pytest.mark.soak
@settings(max_examples=1000, deadline=None)
@given(machines(), HAPPENINGS)
def test_a_thousand_runs_keep_the_laws(machine: Machine, happenings: list[str]) -> None:
    keeps_the_laws(machine, happenings)


def keeps_the_laws(machine: Machine, happenings: list[str]) -> None:
    steps = run(machine, happenings)
    assert run(machine, happenings) == steps, "the same events give the same steps"
    assert run(machine, happenings, through_disk=True) == steps, "and so they do through a disk"
    for taken in steps:
        for inner, snapshot in running(machine, taken.snapshot):
            is_legal(inner, snapshot.configuration)
            waits_in_active_states(inner, snapshot)
    ends_once(steps)


def is_legal(machine: Machine, names: frozenset[str]) -> None:
    """Check that compound states have one active child, parallel ones all, and inactive states none."""
    for state in machine.states.values():
        active = [c for c in state.children if machine.states[c].name in names]
        if state.path and state.name not in names:
            assert not active
        elif state.kind is StateKind.COMPOUND:
            assert len(active) == 1
        elif state.kind is StateKind.PARALLEL:
            assert active == [c for c in state.children if machine.states[c].kind is not StateKind.HISTORY]


def waits_in_active_states(machine: Machine, snapshot: Snapshot) -> None:
    active = {path for path, s in machine.states.items() if not path or s.name in snapshot.configuration}
    assert snapshot.doing.keys() <= active
    assert {timer.state for timer in snapshot.timers if timer.kind != "send"} <= active
    assert {child.state for child in snapshot.invoked.values()} <= active


def ends_once(steps: list[Step]) -> None:
    """Check that each command that began ends once, and that no id is used again."""
    begun: list[str] = []
    ended: list[str] = []
    for taken in steps:
        begun += [command.id for command in taken.commands if isinstance(command, Start)]
        ended += [command.id for command in taken.commands if isinstance(command, Cancel)]
        assert set(ended) <= set(begun)
    for ids in ([id.partition("@")[0] for id in begun], ended):
        assert len(ids) == len(set(ids))
