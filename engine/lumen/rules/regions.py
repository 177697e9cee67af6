"""Transitions from one region into another: they leave and enter the whole parallel state."""

from lumen.language.diagnostics import WARNING, Code
from lumen.language.machines import MachineDefinition, StateKind, Transition
from lumen.loading.document_report import DocumentReport
from lumen.loading.draft import ProjectDraft
from lumen.rules.statecharts import within

CROSSES_REGIONS = Code(
    "crosses-regions", "statecharts", WARNING,
    "a transition leads into another region, so that all regions are left and begin anew",
)  # fmt: skip


def check(draft: ProjectDraft) -> None:
    """Report transitions that leave regions other than their own."""
    for name, machine in draft.behaviors.items():
        report = draft.report("behaviors", name)
        for state in machine.states.values():
            for transition in state.transitions:
                _crossing(machine, transition, report)


def _crossing(machine: MachineDefinition, transition: Transition, report: DocumentReport) -> None:
    """A parallel state is never the domain of a transition (SCXML's findLCCA), so the state around it is."""
    path: str | None = transition.source
    while path is not None:
        parallel = machine.states[path]
        inside = [target for target in transition.targets if target != path and within(target, path)]
        if inside and len(inside) == len(transition.targets):
            break
        path = parallel.parent
    else:
        return
    regions = [child for child in parallel.children if machine.states[child].kind is not StateKind.HISTORY]
    entered = {region for region in regions for target in inside if within(target, region)}
    explicit = transition.reenter and transition.source == path
    if parallel.kind is not StateKind.PARALLEL or explicit or len(entered) == len(regions):
        return
    others = [f"`{machine.states[r].name}`" for r in regions if r not in entered]
    whole = f"`{parallel.name}`" if parallel.name else "the behaviour"
    target = machine.states[inside[0]].name
    region = "one region" if transition.source == path else "another region"
    message = f"`{target}` is in {region}, so all of {whole} is left and begins anew"
    hint = (
        f"what is said in {' and '.join(others)} is cut off, and timers restart: raise an event that the region of"
        f" `{target}` waits for instead, `actions: {{raise: …}}`"
    )
    report(CROSSES_REGIONS, transition.where, message, hint)
