"""Which states a step entered, and why, in a few words."""

from collections.abc import Iterable

from lumen.interpreters.statechart import Step
from lumen.language.machines import Machine, Transition


def innermost(machine: Machine, names: Iterable[str]) -> list[str]:
    """Of these states the ones that no other of them lies in."""
    listed = list(names)
    states = {state.name: state for state in machine.states.values()}
    parents = {states[name].parent for name in listed if name in states}
    return [name for name in listed if name not in states or states[name].path not in parents]


def why(step: Step) -> str:
    """The last transition that led somewhere: what it waited for, and the guard that held."""
    taken = next((t for t in reversed(step.transitions) if t.targets), None)
    if taken is None:
        return "at the start" if step.event is None else f"{step.event.name}"
    guard = f", as {taken.guard.source}" if taken.guard else ""
    return _cause(taken, step) + guard


def _cause(taken: Transition, step: Step) -> str:
    if taken.delay is not None:
        return f"after {taken.delay:g} s"
    if taken.event.startswith("done."):
        return "done"
    if taken.event.startswith("error."):
        reasons = [event.data.get("reason", "") for event in step.raised if event.name == taken.event and event.data]
        return f"failed: {reasons[-1]}" if reasons else "failed"
    return taken.event or "at once"
