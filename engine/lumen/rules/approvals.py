"""Transitions that wait for approval: whether their event comes from outside, so that it can wait."""

from collections.abc import Iterator

from lumen.language.actions import Raise, Send
from lumen.language.machines import MachineDefinition
from lumen.loading.draft import ProjectDraft
from lumen.loading.transitions import MISPLACED_APPROVAL
from lumen.rules.events import hears
from lumen.rules.recipients import sent_to
from lumen.rules.walk import action_sites


def check(draft: ProjectDraft) -> None:
    """Report those whose event a behaviour raises or sends: nobody waits within a step."""
    for name, machine in draft.behaviors.items():
        marked = [t for state in machine.states.values() for t in state.transitions if t.approve]
        own = {*_own(machine), *sent_to(draft, machine)} if marked else set[str]()
        for transition in marked:
            if event := next((event for event in sorted(own) if hears(transition.event, event)), ""):
                message = f"`{event}` comes from a behaviour: only what comes from outside can wait for approval"
                hint = "mark the transition that leads there, or let a button raise the event"
                report = draft.report("behaviors", name)
                report(MISPLACED_APPROVAL, (*transition.where, "approve"), message, hint, key=True)


def _own(machine: MachineDefinition) -> Iterator[str]:
    for site in action_sites(machine):
        match site.step.action:
            case Raise(event) | Send(event):
                yield event
