"""The states in which the content of a history state still matters, because it can be restored from there."""

from collections.abc import Iterator, Mapping

from lumen.language.machines import MachineDefinition, State, StateKind, is_within


def history_uses(machine: MachineDefinition) -> Mapping[str, frozenset[str]]:
    """Return for each history state the names of the states from which it can be restored before it is overwritten.

    A history is overwritten when its parent is left, so a path through the parent does not count. The states that a
    transition enters are approximated: the result can contain too many states, but lacks none that matters.
    """
    histories = (state for state in machine.states.values() if state.kind is StateKind.HISTORY)
    return {state.path: _uses(machine, state) for state in histories}


def _uses(machine: MachineDefinition, history: State) -> frozenset[str]:
    home = history.parent or ""
    leads = {path: set(_led_to(machine, state, home)) for path, state in machine.states.items()}
    found = {path for path, targets in leads.items() if history.path in targets}
    while more := {path for path, targets in leads.items() if path not in found and targets & found}:
        found |= more
    return frozenset(machine.states[path].name for path in found if not is_within(path, home))


def _led_to(machine: MachineDefinition, state: State, home: str) -> Iterator[str]:
    """Yield the paths that a state's transitions can enter without entering `home`."""
    for transition in state.transitions:
        for target in transition.targets:
            kind = machine.states[target].kind
            if kind is StateKind.HISTORY:
                yield target
                target = machine.states[target].parent or ""
            if not is_within(target, home):
                yield from (path for path in machine.states if is_within(path, target) and not is_within(path, home))
                yield from (path for path in machine.states if path and is_within(target, path))
