"""Statecharts: states that can't be reached, and transitions that are never taken."""

from collections.abc import Iterator

from lumen.language.machines import Kind, Machine, State, Transition
from lumen.loading.draft import Draft
from lumen.loading.source import Report
from lumen.rules.events import hears
from lumen.rules.finding import find


def check(draft: Draft) -> None:
    """Report what can never happen, in files where nothing is broken: there it could be for another reason."""
    for name, machine in draft.behaviors.items():
        report = draft.report("behaviors", name)
        if not report.diagnostics:
            _unreachable(machine, report)
            _shadowed(machine, report)
            _endless(machine, report)


def reachable(machine: Machine, begin: str = "") -> set[str]:
    """The paths of all states that some sequence of events could enter from `begin`, whatever guards say."""
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
    """Where one gets from a state: down by default, and by its transitions."""
    yield from state.initial
    if state.kind is Kind.PARALLEL:
        yield from state.children
    if state.on_reload:
        yield state.on_reload
    for transition in state.transitions:
        yield from transition.targets


def _unreachable(machine: Machine, report: Report) -> None:
    found = reachable(machine)
    for path, state in machine.states.items():
        if path not in found:
            found |= reachable(machine, path)  # what only this one leads to is not said as well
            hint = "let a transition go there, or delete it"
            find(report, "unreachable-state", state.where, f"no transition leads to `{path}`", hint, key=True)


def _shadowed(machine: Machine, report: Report) -> None:
    for state in machine.states.values():
        always: list[Transition] = []
        for transition in state.transitions:
            earlier = next((t for t in always if _covers(t, transition)), None)
            if earlier:
                line = report.document.place(earlier.where).line
                message = f"this is never taken: the transition in line {line} always is, before it"
                find(report, "shadowed-transition", transition.where, message, "give that one a `guard`, or swap them")
            if transition.guard is None:
                always.append(transition)


def _endless(machine: Machine, report: Report) -> None:
    """States that lead back to themselves by `always` alone, nothing asked on the way."""
    onward = {path: found for path in machine.states if (found := _at_once(machine, path))}
    said: set[str] = set()
    for path in onward:
        way = [path]
        while (following := onward.get(way[-1])) and following[1] not in way:
            way.append(following[1])
        if following and following[1] == path and path not in said:
            said.update(way)
            hint = "give one of them a `guard`, or let an event lead on"
            names = " → ".join(f"`{machine.states[p].name}`" for p in (*way, path))
            find(report, "endless-always", onward[path][0].where, f"this never comes to rest: {names}", hint)


def _at_once(machine: Machine, path: str) -> tuple[Transition, str] | None:
    """The transition that an atomic state takes as soon as it is entered, and the atomic state that it leads to."""
    state = machine.states[path]
    always = next((t for t in state.transitions if not t.event), None)
    if state.kind is not Kind.ATOMIC or always is None or always.guard or len(always.targets) != 1:
        return None
    target = machine.states[always.targets[0]]
    while target.kind is Kind.COMPOUND and len(target.initial) == 1:
        target = machine.states[target.initial[0]]
    return (always, target.path) if target.kind is Kind.ATOMIC else None


def _covers(earlier: Transition, later: Transition) -> bool:
    """Whether whatever could take the later one takes the earlier one first."""
    if earlier.exact or later.exact or not (earlier.event and later.event):
        return earlier.event == later.event
    return hears(earlier.event, later.event.removesuffix(".*")) and (later.event != "*" or earlier.event == "*")
