"""The recipients of `send`: invoked behaviours, the invoking behaviour, and other robots' behaviours."""

from collections.abc import Iterator

from lumen.language.actions import PARENT, Send
from lumen.language.diagnostics import WARNING, Code, did_you_mean
from lumen.language.machines import MachineDefinition
from lumen.lint.walk import ActionSite, action_sites
from lumen.project.document_report import DocumentReport
from lumen.project.draft import ProjectDraft

UNKNOWN_RECIPIENT = Code(
    "unknown-recipient", "references", WARNING, "a `send` goes to a behaviour that is never invoked"
)


def check(draft: ProjectDraft) -> None:
    """Report every `send` to an id under which its behaviour invokes nothing."""
    for name, machine in draft.behaviors.items():
        report = draft.report("behaviors", name)
        for site, send in _sends(machine):
            if send.to != PARENT and report.whole:
                _known(machine, report, site, send)


def recipients(draft: ProjectDraft, name: str, send: Send) -> list[MachineDefinition]:
    """Return the behaviours that receive an event sent by the behaviour `name`.

    Behaviours that were not read are left out.
    """
    if send.to == PARENT:
        return [machine for machine in draft.behaviors.values() if name in set(_invoked(machine).values())]
    behavior = _invoked(draft.behaviors[name]).get(send.to)
    if behavior is None and draft.settings and send.to in draft.behaviors[name].robots:
        behavior = draft.settings.robots[send.to].behavior
    return [draft.behaviors[behavior]] if behavior in draft.behaviors else []


def sent_to(draft: ProjectDraft, machine: MachineDefinition) -> set[str]:
    """Return the events that any behaviour sends to this behaviour."""
    return {
        send.event
        for name, other in draft.behaviors.items()
        for _, send in _sends(other)
        if any(heard is machine for heard in recipients(draft, name, send))
    }


def _invoked(machine: MachineDefinition) -> dict[str, str]:
    """Return the names of the behaviours that a behaviour invokes, by their ids."""
    return {invoke.id: invoke.behavior for state in machine.states.values() for invoke in state.invoke}


def _known(machine: MachineDefinition, report: DocumentReport, site: ActionSite, send: Send) -> None:
    ids = _invoked(machine).keys()
    if send.to not in ids and send.to not in machine.robots:
        hint = did_you_mean(send.to, {*ids, *machine.robots, PARENT}, "`send` can go to")
        report(UNKNOWN_RECIPIENT, (*site.step.where, "send", "to"), f"there is no recipient `{send.to}`", hint)


def _sends(machine: MachineDefinition) -> Iterator[tuple[ActionSite, Send]]:
    """Yield each `send` to another behaviour, with its place."""
    for site in action_sites(machine):
        if isinstance(site.step.action, Send) and site.step.action.to:
            yield site, site.step.action
