"""Transitions from one region into another, which exit and enter the whole parallel state."""

from itertools import islice

from lumen.language.diagnostics import WARNING, Code
from lumen.language.machines import MachineDefinition, StateKind, Transition, is_within
from lumen.project.document_report import DocumentReport
from lumen.project.draft import ProjectDraft

CROSSES_REGIONS = Code(
    "crosses-regions",
    "statecharts",
    WARNING,
    "a transition leads into another region, so all regions are left and restarted",
)

MAX_SHOWN_REGIONS = 6
"""The maximum number of regions that the hint names."""


def check(draft: ProjectDraft) -> None:
    """Report transitions that leave regions other than their own."""
    for name, machine in draft.behaviors.items():
        report, regions = draft.report("behaviors", name), _regions(machine)
        for state in machine.states.values():
            for transition in state.transitions:
                _crossing(machine, transition, regions, report)


def _regions(machine: MachineDefinition) -> dict[str, dict[str, str]]:
    """Return the regions of each parallel state, as names by path."""
    states = machine.states
    return {
        path: {child: states[child].name for child in state.children if states[child].kind is not StateKind.HISTORY}
        for path, state in states.items()
        if state.kind is StateKind.PARALLEL
    }


def _crossing(
    machine: MachineDefinition, transition: Transition, regions_of: dict[str, dict[str, str]], report: DocumentReport
) -> None:
    """Report a transition whose targets are in a parallel state, but not in all its regions.

    A parallel state is never a transition's domain (findLCCA in SCXML), so the transition exits and enters all of it.
    """
    path: str | None = transition.source
    while path is not None:
        parallel = machine.states[path]
        inside = [target for target in transition.targets if target != path and is_within(target, path)]
        if inside and len(inside) == len(transition.targets):
            break
        path = parallel.parent
    else:
        return
    if parallel.kind is not StateKind.PARALLEL or (transition.reenter and transition.source == path):
        return
    regions = regions_of[path]
    entered = {_child(machine, path, target) for target in inside} & regions.keys()
    if len(entered) == len(regions):
        return
    others = [f"`{name}`" for name in islice((regions[r] for r in regions if r not in entered), MAX_SHOWN_REGIONS)]
    if len(regions) - len(entered) > MAX_SHOWN_REGIONS:
        others.append("others")
    whole = f"`{parallel.name}`" if parallel.name else "the behaviour"
    target = machine.states[inside[0]].name
    region = "one region" if transition.source == path else "another region"
    message = f"`{target}` is in {region}, so all of {whole} is left and restarted"
    hint = (
        f"use `actions: {{raise: …}}` with an event that the region of `{target}` waits for: a transition cuts off"
        f" speech in {', '.join(others)} and restarts timers"
    )
    report(CROSSES_REGIONS, transition.where, message, hint)


def _child(machine: MachineDefinition, path: str, below: str) -> str:
    """Return the child of the state `path` that contains the state `below`."""
    while (parent := machine.states[below].parent) is not None and parent != path:
        below = parent
    return below
