"""Offers to a language model: the behaviour must declare the offered event and describe its data."""

from lumen.language.diagnostics import WARNING, Code
from lumen.project.draft import ProjectDraft

MISPLACED_OFFER = Code(
    "misplaced-offer",
    "knowledge",
    WARNING,
    "an event is offered to a language model, but is not declared under `events`",
)


def check(draft: ProjectDraft) -> None:
    """Report `offer: true` on a row of `hears`, or on a transition whose event is not declared under `events`."""
    for name, machine in draft.behaviors.items():
        report = draft.report("behaviors", name)
        for transition in (t for state in machine.states.values() for t in state.transitions if t.offer):
            if transition.event not in machine.events or transition.hears:
                what = (
                    f"`{transition.event}`"
                    if transition.event and not transition.timed
                    else "a transition without an event"
                )
                message = f"{what} is offered to a language model, but is not declared under `events`"
                hint = "offer an event that nothing else raises, and describe its data under `events`"
                if transition.hears:
                    message = "a row of `hears` is offered to a language model, which could then speak for the visitor"
                report(MISPLACED_OFFER, (*transition.where, "offer"), message, hint, key=True)
