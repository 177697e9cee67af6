"""A running behaviour that goes on under another machine: a pure plan, or the reason why there is none."""

from collections.abc import Mapping
from typing import Any, NamedTuple

from lumen.interpreters.statechart import Snapshot, Timer
from lumen.interpreters.statechart.types import type_checks
from lumen.language.actions import If, Parallel, Step
from lumen.language.machines import Kind, Machine, State


class Refusal(NamedTuple):
    """Why the snapshot can't go on under the new machine now; it may later, when the state named was left."""

    reason: str


def migrate(old: Machine, new: Machine, snapshot: Snapshot) -> Snapshot | Refusal:
    """The snapshot as it goes on under `new`, or a refusal that leaves everything as it was.

    Active states keep their identity by path, are not re-entered, and keep their timers' deadlines. Context keeps every
    key still declared and of a type that fits; a new key has its first value.
    """
    if old == new:
        return snapshot
    active = [path for path, state in old.states.items() if not path or state.name in snapshot.configuration]
    if reason := _illegal(new, active) or _changed(old, new, snapshot):
        return Refusal(reason)
    return snapshot._replace(
        configuration=frozenset(new.states[path].name for path in active if path),
        context=_context(new, snapshot.context),
        history={
            path: paths
            for path, paths in snapshot.history.items()
            if path in new.states and all(p in new.states for p in paths)
        },
        timers=tuple(timer for timer in snapshot.timers if _lives(new, timer)),
    )


def _illegal(new: Machine, active: list[str]) -> str:
    """Why these paths are no configuration of the new machine; empty where they are one."""
    if gone := [path for path in active if path not in new.states]:
        return f"state `{gone[-1]}` is active and no longer there"
    for path in active:
        state = new.states[path]
        children = [child for child in state.children if new.states[child].kind is not Kind.HISTORY]
        running = [child for child in children if child in active]
        needed = len(children) if state.kind is Kind.PARALLEL else min(1, len(children))
        if len(running) != needed:
            return f"state `{path or new.id}` is active and has other states inside it now"
    return ""


def _changed(old: Machine, new: Machine, snapshot: Snapshot) -> str:
    """Which `do` under way has another shape now; texts and names in it may differ."""
    for path in snapshot.doing:
        if _shape(old.states[path]) != _shape(new.states[path]):
            return f"what state `{path}` is doing has changed: until it is left"
    return ""


def _shape(state: State) -> object:
    return _shapes(state.do)


def _shapes(steps: tuple[Step, ...]) -> tuple[object, ...]:
    """The verbs, nested as they are."""
    found: list[object] = []
    for step in steps:
        match step.action:
            case If(_, then, otherwise):
                found.append(("if", _shapes(then), _shapes(otherwise)))
            case Parallel(branches):
                found.append(("parallel", _shapes(branches)))
            case action:
                found.append(type(action).__name__)
    return tuple(found)


def _context(new: Machine, context: Mapping[str, Any]) -> dict[str, Any]:
    checks = type_checks(new)
    kept = {
        key: context[key]
        for key, check in checks.items()
        if key in context and (check is None or check.accepts(context[key]))
    }
    return {**new.context, **kept}


def _lives(new: Machine, timer: Timer) -> bool:
    """Whether what the timer ends is still there; a delayed `send` always is."""
    if timer.kind != "after":
        return True
    state = new.states.get(timer.state)
    return state is not None and any(t.event == timer.event and t.delay is not None for t in state.transitions)
