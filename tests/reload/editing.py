"""Random edits of behaviours, and the snapshots of the behaviours in between."""

from collections.abc import Iterator
from contextlib import suppress
from copy import deepcopy
from typing import Any

from hypothesis import strategies as st

from lumen.errors import LumenError
from lumen.language.events import Event
from lumen.statechart import Machine, Snapshot, due, initial, step
from tests.statechart.oracle.generating import Data

Happenings = list[tuple[str, Any] | None]


def states_of(data: Data, path: str = "") -> Iterator[tuple[str, Data]]:
    """Yield every state below, by path, in the order of the file."""
    for key, state in (data.get("states") or {}).items():
        below = f"{path}.{key}".lstrip(".")
        yield below, state
        yield from states_of(state, below)


@st.composite
def edits(draw: st.DrawFn, before: Data) -> Data:
    """Draw the behaviour with one to three edits, some of them careless; it may be no machine any more."""
    data = deepcopy(before)
    for _ in range(draw(st.integers(1, 3))):
        draw(st.sampled_from([renaming, deletion, insertion, regrouping, retiming, redoing, rescuing]))(draw, data)
    return data


def renaming(draw: st.DrawFn, data: Data) -> None:
    """Rename a state, and declare the rename or not."""
    path, _ = draw(st.sampled_from(list(states_of(data))))
    home, _, key = path.rpartition(".")
    children = _at(data, home)["states"]
    renamed = {("new" if k == key else k): state for k, state in children.items()}
    if "new" in children:
        return
    _at(data, home)["states"] = renamed
    now = f"{home}.new".lstrip(".")
    _retarget(data, lambda name: f"#{now}{name[1 + len(path) :]}" if _lies_in(name, path) else name)
    if draw(st.booleans()):
        data["renamed"] = {**data.get("renamed", {}), path: now}


def deletion(draw: st.DrawFn, data: Data) -> None:
    """Remove a state; transitions to it lead to a sibling instead."""
    path, _ = draw(st.sampled_from(list(states_of(data))))
    home, _, key = path.rpartition(".")
    children = _at(data, home)["states"]
    others = [k for k, state in children.items() if k != key and state.get("type") != "history"]
    if not others:
        return
    del children[key]
    beside = f"#{home}.{others[0]}".replace("#.", "#")
    _retarget(data, lambda name: beside if _lies_in(name, path) else name)


def insertion(draw: st.DrawFn, data: Data) -> None:
    """Give a state, which may have none, another state within."""
    _, state = draw(st.sampled_from([("", data), *states_of(data)]))
    if state.get("type") not in ("final", "history"):
        children = {} if state.get("states") is None else state["states"]
        state["states"] = {"fresh": {"do": {"say": "hello"}, "entry": {"log": "in"}}, **children}
        if not children:
            state.pop("onDone", None)


def regrouping(draw: st.DrawFn, data: Data) -> None:
    """Make a compound state parallel, or the other way round."""
    _, state = draw(st.sampled_from([("", data), *states_of(data)]))
    if state.get("states"):
        state.pop("initial", None)
        if state.pop("type", "") != "parallel":
            state["type"] = "parallel"


def retiming(draw: st.DrawFn, data: Data) -> None:
    """Change the times after which states are left."""
    for _, state in states_of(data):
        if "after" in state and draw(st.booleans()):
            [(_, row)] = state["after"].items()
            state["after"] = {draw(st.sampled_from(["50ms", "300ms", "2s"])): row}


def redoing(draw: st.DrawFn, data: Data) -> None:
    """Let a state do something else."""
    atomic = [s for _, s in states_of(data) if not s.get("states") and s.get("type") not in ("final", "history")]
    if atomic:
        draw(st.sampled_from(atomic))["do"] = draw(st.sampled_from([[{"say": "x"}], [{"play": "p"}, {"wait": "1s"}]]))


def rescuing(draw: st.DrawFn, data: Data) -> None:
    """Let a reload go to some state if the active states are gone."""
    for _, state in [("", data), *states_of(data)]:
        if state.get("states") and draw(st.booleans()):
            state["onReload"] = "#" + draw(st.sampled_from([path for path, _ in states_of(data)]))


def built(data: Data) -> Machine | None:
    """Return the machine, None if the edits broke it: a reload never sees such a file."""
    with suppress(LumenError):
        return Machine.from_dict(data)
    return None


def snapshots(machine: Machine, events: Happenings) -> list[Snapshot]:
    """Return the snapshots of the behaviour at the start and after each event."""
    found: list[Snapshot] = []
    with suppress(LumenError):
        found.append(initial(machine).snapshot)
        for event in events:
            found.append(step(machine, found[-1], happen(found[-1], event)).snapshot)
    return found


def happen(snapshot: Snapshot, event: tuple[str, Any] | None) -> Event:
    if event is not None:
        return Event(*event, snapshot.at + 0.05)
    return due(snapshot) or Event("a", None, snapshot.at)


def _at(data: Data, path: str) -> Data:
    for key in filter(None, path.split(".")):
        data = data["states"][key]
    return data


def _lies_in(target: str, path: str) -> bool:
    return target == f"#{path}" or target.startswith(f"#{path}.")


def _retarget(data: Any, change: Any) -> None:
    """Change every target, initial state and `onReload`."""
    for key, value in data.items() if isinstance(data, dict) else enumerate(data):
        if key in ("target", "initial", "onReload"):
            data[key] = change(value) if isinstance(value, str) else [change(name) for name in value]
        elif isinstance(value, dict | list):
            _retarget(value, change)
