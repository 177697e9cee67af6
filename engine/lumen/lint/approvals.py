"""Transitions that wait for approval: whether their event comes from outside the behaviour, and can wait."""

from collections.abc import Iterator

from lumen.language.actions import Raise, Send
from lumen.language.diagnostics import WARNING, Code
from lumen.language.machines import MachineDefinition
from lumen.lint.events import hears
from lumen.lint.recipients import sent_to
from lumen.lint.walk import action_sites
from lumen.project.draft import ProjectDraft
from lumen.project.transitions import MISPLACED_APPROVAL

SAFETY_WAITS = Code("safety-waits", "statecharts", WARNING, "a safety reaction waits until a person approves it")

SAFETY = ("stop", "fallen", "motors.hot", "robot.lost", "brain.lost", "motion.lost")
"""Events that need an immediate reaction."""


def check(draft: ProjectDraft) -> None:
    """Report `approve` on events that the behaviour raises or that any behaviour sends, and on urgent events.

    An event from inside is processed within the same step, in which the console can't answer.
    """
    for name, machine in draft.behaviors.items():
        marked = [t for state in machine.states.values() for t in state.transitions if t.approve]
        own = {*_own(machine), *sent_to(draft, machine)} if marked else set[str]()
        report = draft.report("behaviors", name)
        for transition in marked:
            if event := next((event for event in SAFETY if hears(transition.event, event)), ""):
                message = f"`approve` delays the reaction to `{event}` until a person approves it"
                hint = "delete `approve` here, because the console may be unattended; add it to a later transition"
                report(SAFETY_WAITS, (*transition.where, "approve"), message, hint, key=True)
            if event := next((event for event in sorted(own) if hears(transition.event, event)), ""):
                message = f"`{event}` comes from a behaviour: only events from outside can wait for approval"
                hint = "put `approve` on an earlier transition, or let a button raise the event"
                report(MISPLACED_APPROVAL, (*transition.where, "approve"), message, hint, key=True)


def _own(machine: MachineDefinition) -> Iterator[str]:
    for site in action_sites(machine):
        match site.step.action:
            case Raise(event) | Send(event):
                yield event
