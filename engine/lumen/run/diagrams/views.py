"""The views of a behaviour that a picture can show: the whole, one region, or one state with its neighbours."""

from collections import Counter
from collections.abc import Callable, Iterable

from lumen.errors import UsageError
from lumen.language.diagnostics import did_you_mean
from lumen.language.machines import MachineDefinition, State, StateKind, is_within
from lumen.run.captions import invocation
from lumen.run.diagrams.diagram import Diagram, StateBox
from lumen.run.diagrams.transition_rows import made, rows_of, short_name

MAX_STATES_WITH_ROWS = 16
"""The number of states above which the whole shows only states and arrows."""
MAX_ARROWS_IN = 5
"""The number of arrows above which a state is a hub: they would hide the others, so its box shows their number."""


def overview(machine: MachineDefinition) -> Diagram:
    """Return the picture of the whole behaviour, with the invoked behaviours as rows."""
    root = machine.root
    rows = len(machine.states) <= MAX_STATES_WITH_ROWS
    box = _box(machine, root, _led_here(machine), rows=rows)
    return Diagram(machine.id, (box,) if root.kind is StateKind.PARALLEL or box.rows else box.within, _arrows(machine))


def region(machine: MachineDefinition, name: str) -> Diagram:
    """Return the picture of a state's content and transitions.

    Raises UsageError if no state of that name contains others.
    """
    state = _named(machine, name, lambda state: bool(state.children))
    box = _box(machine, state, _led_here(machine), rows=True)
    return Diagram(f"{machine.id}: {state.name}", (box,), _arrows(machine, state.path))


def neighbourhood(machine: MachineDefinition, name: str) -> Diagram:
    """Return the picture of a state, with the states that lead to it and those to which it leads.

    Raises UsageError if the state does not exist.
    """
    state = _named(machine, name, lambda _: True)
    around = [state, *(machine.states[path] for path in _above(machine, state))]
    out = {target for each in around for t in each.transitions for target in t.targets}
    inward = [s for s in machine.states.values() if any(state.path in t.targets for t in s.transitions)]
    before = [_alone(machine, s, tuple(rows_of(machine, s, state.path))) for s in inward if s is not state]
    here = [row for each in around for row in _rows(machine, each)]
    own = _alone(machine, state, tuple(dict.fromkeys(here)), marked=True)
    after = [_alone(machine, machine.states[path]) for path in machine.states if path in out and path != state.path]
    seen = {box.id for box in before}
    boxes = (*before, own, *(box for box in after if box.id not in seen))
    arrows = [*((box.id, own.id) for box in before), *((own.id, box.id) for box in after)]
    return Diagram(f"{machine.id}: {state.name}", boxes, tuple(arrows))


def _box(machine: MachineDefinition, state: State, led: Counter[str], *, rows: bool, first: bool = False) -> StateBox:
    """Return the box of a state with its content; `led` has the number of other states that lead to each path."""
    children = [machine.states[path] for path in state.children]
    within = [child for child in children if child.kind is not StateKind.HISTORY and not made(child.where)]
    begins = [within[0].path] if state.for_each else state.initial
    hub = led[state.path]
    said = list(_rows(machine, state)) if rows else list(_runs(state))
    if hub > MAX_ARROWS_IN:
        said.append(f"← from {hub} states")
    return StateBox(
        state.path or machine.id,
        _title(machine, state),
        tuple(said),
        tuple(_box(machine, child, led, rows=rows, first=child.path in begins) for child in within),
        parallel=state.kind is StateKind.PARALLEL,
        final=state.kind is StateKind.FINAL,
        first=first,
    )


def _alone(machine: MachineDefinition, state: State, rows: tuple[str, ...] = (), *, marked: bool = False) -> StateBox:
    title = _title(machine, state)
    return StateBox(state.path or machine.id, title, rows, final=state.kind is StateKind.FINAL, marked=marked)


def _title(machine: MachineDefinition, state: State) -> str:
    return short_name(machine.states, state.path) if state.path else machine.id


def _rows(machine: MachineDefinition, state: State) -> Iterable[str]:
    yield from _runs(state)
    yield from rows_of(machine, state)


def _runs(state: State) -> Iterable[str]:
    """Yield a row for each behaviour that a state invokes, and a row for its `for`."""
    yield from (f"invokes {invocation(invoke)}" for invoke in state.invoke)
    if state.for_each:
        yield f"for each {state.for_each.variable}"


def _arrows(machine: MachineDefinition, within: str = "") -> tuple[tuple[str, str], ...]:
    """Return arrows as pairs of ids, except those to a hub, and those between a state and its content.

    Only arrows inside the state at the path `within` are returned; an empty path stands for all.
    """
    hubs = {path for path, count in _led_here(machine).items() if count > MAX_ARROWS_IN}
    found: dict[tuple[str, str], None] = {}
    for state in machine.states.values():
        for target in (target for t in state.transitions for target in t.targets):
            end = _drawn(machine, target)
            nested = any(is_within(one, other) for one, other in ((state.path, end), (end, state.path)))
            if not nested and end not in hubs and is_within(state.path, within) and is_within(end, within):
                found[state.path or machine.id, end] = None
    return tuple(found)


def _drawn(machine: MachineDefinition, path: str) -> str:
    """Return the path of the state whose box is drawn: for a history state, its parent."""
    state = machine.states[path]
    return state.parent or "" if state.kind is StateKind.HISTORY else path


def _led_here(machine: MachineDefinition) -> Counter[str]:
    """Return the number of other states that lead to each state, by path."""
    pairs = {(s.path, _drawn(machine, e)) for s in machine.states.values() for t in s.transitions for e in t.targets}
    return Counter(end for start, end in pairs if start != end)


def _above(machine: MachineDefinition, state: State) -> Iterable[str]:
    parent = state.parent
    while parent:
        yield parent
        parent = machine.states[parent].parent


def _named(machine: MachineDefinition, name: str, wanted: Callable[[State], bool]) -> State:
    states = [state for state in machine.states.values() if state.path and wanted(state)]
    ends = [state for state in states if state.path.rpartition(".")[2] == name]
    found = [state for state in states if name in (state.name, state.path)] or (ends if len(ends) == 1 else [])
    if not found:
        hint = did_you_mean(name, [state.name for state in states], "there are")
        raise UsageError(f"`{machine.id}` has no state `{name}`: {hint}")
    return found[0]
