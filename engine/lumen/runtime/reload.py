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
        timers=_timers(old, new, snapshot, active),
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
    """Which `do` under way has another shape now (texts and names in it may differ), or what that runs is another."""
    for path in snapshot.doing:
        if _shape(old.states[path]) != _shape(new.states[path]):
            return f"what state `{path}` is doing has changed: until it is left"
    for id, child in snapshot.invoked.items():
        if _behind(old, child.state, id) != _behind(new, child.state, id):
            return f"what state `{child.state or new.id}` has invoked (`{id}`) has changed: until it is left"
    return ""


def _behind(machine: Machine, path: str, id: str) -> Machine | None:
    """The machine that a state invokes under that id, None where it does not."""
    found = [invoke.behavior for invoke in machine.states[path].invoke if invoke.id == id]
    return machine.invoked[found[0]] if found else None


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


def _timers(old: Machine, new: Machine, snapshot: Snapshot, active: list[str]) -> tuple[Timer, ...]:
    """Every timer whose end is still there, with its deadline; an active state's new or changed `after` is armed.

    A changed one runs from when the one that it replaces was set, a new one from now.
    """
    afters = {path: _afters(new.states[path]) for path in active}
    kept = [timer for timer in snapshot.timers if timer.kind != "after" or timer.event in afters.get(timer.state, {})]
    replaced = [timer for timer in snapshot.timers if timer not in kept]
    for path, delays in afters.items():
        for event in delays.keys() - _afters(old.states[path]).keys():
            before = next((timer for timer in replaced if timer.state == path), None)
            if before:
                replaced.remove(before)
            since = before.due - before.delay if before else snapshot.at
            kept.append(Timer(event, since + delays[event], delays[event], event, None, path, "after"))
    return tuple(kept)


def _afters(state: State) -> dict[str, float]:
    """The delays [s] of a state's `after`, by the event that each raises."""
    return {t.event: t.delay for t in state.transitions if t.delay is not None}
