"""Which states a step entered, and why, in a few words."""

from collections.abc import Iterable, Mapping

from lumen.language.events import Event
from lumen.language.machines import MachineDefinition, Transition
from lumen.statechart import Step


def innermost(machine: MachineDefinition, names: Iterable[str]) -> list[str]:
    """Of these states the ones that no other of them lies in."""
    listed = list(names)
    states = {state.name: state for state in machine.states.values()}
    parents = {states[name].parent for name in listed if name in states}
    return [name for name in listed if name not in states or states[name].path not in parents]


def why(step: Step) -> str:
    """The transitions that led somewhere, one after the other: what each waited for, and the guard that held."""
    causes = list(dict.fromkeys(_cause(t, step) for t in step.transitions if t.targets))
    if not causes:
        return "at the start" if step.event is None else step.event.name
    return ", then ".join(causes[:3]) + (", …" if len(causes) > 3 else "")


def reason_of(event: Event) -> str:
    """The reason that an error says, empty where it says none."""
    return str(event.data.get("reason", "")) if isinstance(event.data, Mapping) else ""


def _cause(taken: Transition, step: Step) -> str:
    return _trigger(taken, step) + (f", as {taken.guard.shown}" if taken.guard else "")


def _trigger(taken: Transition, step: Step) -> str:
    if taken.hears:
        return taken.hears.title
    if taken.timed:
        return taken.awaited_time
    if taken.event.startswith("done."):
        return "done"
    if taken.event.startswith("error."):
        reasons = [reason for event in step.raised if event.name == taken.event and (reason := reason_of(event))]
        return f"failed: {reasons[-1]}" if reasons else "failed"
    return taken.event or "at once"
