"""Short explanations of why a step entered its states."""

from collections.abc import Iterable, Mapping

from lumen.language.events import Event
from lumen.language.machines import MachineDefinition, Transition
from lumen.statechart import Step


def innermost(machine: MachineDefinition, names: Iterable[str]) -> list[str]:
    """Return those of the named states that are not the parent of another named state."""
    if not (listed := list(names)):
        return []
    states = {state.name: state for state in machine.states.values()}
    parents = {states[name].parent for name in listed if name in states}
    return [name for name in listed if name not in states or states[name].path not in parents]


def why(step: Step) -> str:
    """Return the causes of a step's entries: the triggers of transitions, with their guards; at most three are named.

    Without a transition, return the event's name, or `at the start`.
    """
    causes = list(dict.fromkeys(_cause(t, step) for t in step.transitions if t.targets))
    if not causes:
        return "at the start" if step.event is None else step.event.name
    return ", then ".join(causes[:3]) + (", …" if len(causes) > 3 else "")


def reason_of(event: Event) -> str:
    """Return the reason in an error's data, or an empty string."""
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
