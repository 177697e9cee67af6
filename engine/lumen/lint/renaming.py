"""Entries of `renamed`: the old name must no longer exist."""

from lumen.language.diagnostics import ERROR, Code
from lumen.language.machines import MachineDefinition
from lumen.project.document_report import DocumentReport
from lumen.project.draft import ProjectDraft

STILL_THERE = Code("still-there", "statecharts", ERROR, "`renamed` names a state or key that still has its old name")


def check(draft: ProjectDraft) -> None:
    """Report entries whose old name still exists; two states or keys can exchange their names."""
    for name, machine in draft.behaviors.items():
        _check(machine, draft.report("behaviors", name))


def _check(machine: MachineDefinition, report: DocumentReport) -> None:
    known = {path: path for path in machine.states} | {f"context.{key}": f"context.{key}" for key in machine.context}
    known |= {state.alias: path for path, state in machine.states.items() if path and state.alias}
    taken = set(machine.renamed.values())
    for was, now in machine.renamed.items():
        there = known.get(was)
        if there is not None and (there == now or there not in taken):
            message = f"`{was}` is renamed to `{now}` here, but still exists"
            hint = f"delete this line: the next reload would replace `{was}` with `{now}`"
            report(STILL_THERE, ("renamed", was), message, hint, key=True)
