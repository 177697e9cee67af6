"""Statecharts: unreachable states, and states that are left and entered without end."""

from collections.abc import Iterator, Mapping, Sequence

from lumen.language.actions import Assign, PlacedAction, nested
from lumen.language.diagnostics import MAX_COMPARED_NAMES, WARNING, Code, nearest
from lumen.language.machines import MachineDefinition, State, StateKind, Transition
from lumen.lint.logic import never, tree
from lumen.project.document_report import DocumentReport
from lumen.project.draft import ProjectDraft
from lumen.project.transitions import ENDLESS_ALWAYS

ALWAYS_LOOP = Code("always-loop", "statecharts", WARNING, "an `always` repeats for ever while its guard is true")
UNREACHABLE_STATE = Code("unreachable-state", "statecharts", WARNING, "no transition leads to a state")


MAX_ALWAYS_LOOP = 3
"""The maximum number of transitions in a loop of guarded `always` that is searched for."""

MAX_FOLLOWED_ALWAYS = 4
"""The maximum number of a state's guarded `always` that are followed."""

_LEADS = frozenset(("on", "hears", "always", "after", "at", "onDone", "onError", "onReload", "target", "initial"))
"""Keys whose values name states; an unreadable value of such a key may have named any state."""

Onward = Mapping[str, Sequence[tuple[Transition, str]]]


def check(draft: ProjectDraft) -> None:
    """Report unreachable states and endless loops."""
    torn = {d.place.file for d in draft.loose}
    for name, machine in draft.behaviors.items():
        report = draft.report("behaviors", name)
        if report.document.file not in torn and not any(_LEADS.intersection(path) for path in report.pruned):
            _unreachable(machine, report)
        _endless(machine, report)
        _loops(machine, report)


def reachable(machine: MachineDefinition, begin: str = "") -> set[str]:
    """Return the paths of all states that some sequence of events could enter from `begin`; guards are ignored."""
    found: set[str] = set()
    waiting = [begin]
    while waiting:
        path: str | None = waiting.pop()
        while path is not None and path not in found:
            found.add(path)
            state = machine.states[path]
            waiting.extend(_next(state))
            path = state.parent
    return found


def _next(state: State) -> Iterator[str]:
    """Yield the states that can follow a state: those entered with it, and the targets of its transitions."""
    yield from state.initial
    if state.kind is StateKind.PARALLEL:
        yield from state.children
    if state.on_reload:
        yield state.on_reload
    for transition in state.transitions:
        yield from transition.targets


def _unreachable(machine: MachineDefinition, report: DocumentReport) -> None:
    """Report states to which no transition leads, unless an unreadable part of the file may have named them."""
    meant = {text.rpartition(".")[2].lstrip("#") for text in report.lost | report.missed}
    missed = meant & report.missed if len(report.missed) <= MAX_COMPARED_NAMES else set()
    found = reachable(machine)
    for path, state in machine.states.items():
        key = path.rpartition(".")[2]
        if path not in found and (not meant.isdisjoint((key, state.alias)) or nearest(key, missed)):
            found |= reachable(machine, path)
    for path, state in machine.states.items():
        if path not in found:
            found |= reachable(machine, path)  # don't report states that can be reached only from this one
            hint = "add a transition to it, or delete it"
            report(UNREACHABLE_STATE, state.where, f"no transition leads to `{path}`", hint, key=True)


def _endless(machine: MachineDefinition, report: DocumentReport) -> None:
    """Report states that lead back to themselves by `always` without guards."""
    onward = {path: found for path in machine.states if (found := _at_once(machine, path))}
    said: set[str] = set()
    for path in onward:
        way = [path]
        while (following := onward.get(way[-1])) and following[1] not in way:
            way.append(following[1])
        if following and following[1] == path and path not in said:
            said.update(way)
            hint = "give one of these transitions a `guard`, or wait for an event"
            names = " → ".join(f"`{machine.states[p].name}`" for p in (*way, path))
            report(ENDLESS_ALWAYS, onward[path][0].where, f"this loop never ends: {names}", hint)


def _at_once(machine: MachineDefinition, path: str) -> tuple[Transition, str] | None:
    """Return the `always` that leaves an atomic state on entry, and the path of the next atomic state; else None."""
    state = machine.states[path]
    always = next((t for t in state.transitions if not t.event), None)
    if state.kind is not StateKind.ATOMIC or always is None or always.guard or len(always.targets) != 1:
        return None
    target = machine.states[always.targets[0]]
    while target.kind is StateKind.COMPOUND and len(target.initial) == 1:
        target = machine.states[target.initial[0]]
    return (always, target.path) if target.kind is StateKind.ATOMIC else None


def _loops(machine: MachineDefinition, report: DocumentReport) -> None:
    """Report states that lead back to themselves by guarded `always`, if no action on the way changes the context."""
    onward: dict[str, list[tuple[Transition, str]]] = {}
    for state in machine.states.values():
        if state.kind is StateKind.ATOMIC:
            rows = [t for t in state.transitions if not t.event]
            for transition in (t for t in rows if t.guard or t is rows[0]):
                target = _settled(machine, transition)
                if target and not _assigns(transition.actions):
                    onward.setdefault(state.path, []).append((transition, target))
    said: set[str] = set()
    for path in onward:
        ways = _rounds(machine, onward, path, path, ())
        way = next((way for way in ways if any(t.guard for t in way)), None)
        if way and path not in said:
            said.update(t.source for t in way)
            asked = " and ".join(f"`{t.guard.shown}`" for t in way if t.guard)
            names = " → ".join(f"`{machine.states[p].name}`" for p in (*(t.source for t in way), path))
            message = f"this loop never ends while {asked}: {names}"
            hint = "change a value that the guard checks, or wait for an event"
            report(ALWAYS_LOOP, way[0].where, message, hint, related=[(t.where, "then here") for t in way[1:]])


def _rounds(
    machine: MachineDefinition, onward: Onward, begin: str, path: str, way: tuple[Transition, ...]
) -> Iterator[tuple[Transition, ...]]:
    """Yield the loops of at most MAX_ALWAYS_LOOP transitions back to `begin` whose guards can all be true together.

    `way` has the transitions from `begin` to `path`.
    """
    for transition, target in onward.get(path, ())[:MAX_FOLLOWED_ALWAYS]:
        longer = (*way, transition)
        if _assigns(machine.states[target].entry) or _assigns(machine.states[path].exit):
            continue
        if never(*(tree(t.guard.source) for t in longer if t.guard)):
            continue
        if target == begin:
            yield longer
        elif len(longer) < MAX_ALWAYS_LOOP and all(t.source != target for t in longer):
            yield from _rounds(machine, onward, begin, target, longer)


def _settled(machine: MachineDefinition, transition: Transition) -> str:
    """Return the path of the atomic state to which a transition leads; empty if it does not lead to exactly one."""
    if not transition.targets:
        return transition.source
    if len(transition.targets) > 1:
        return ""
    target = machine.states[transition.targets[0]]
    while target.kind is StateKind.COMPOUND and len(target.initial) == 1:
        target = machine.states[target.initial[0]]
    return target.path if target.kind is StateKind.ATOMIC else ""


def _assigns(block: tuple[PlacedAction, ...]) -> bool:
    return any(isinstance(step.action, Assign) for step in nested(block))
