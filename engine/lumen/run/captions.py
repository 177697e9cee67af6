"""Captions of a diagram's arrows and invocations."""

from lumen.language.machines import Invoke, Transition

MAX_GUARD_LENGTH = 32
"""The length from which the text of a guard is shortened [characters]."""


def invocation(invoke: Invoke) -> str:
    """Return the label of an invocation: `quiz`, or `first: quiz` if the invocation has an id of its own."""
    return invoke.behavior if invoke.id == invoke.behavior else f"{invoke.id}: {invoke.behavior}"


def caption(transition: Transition) -> str:
    """Return `event [guard]` of a transition, with the guard cut to MAX_GUARD_LENGTH.

    The event is the key of a `hears` row, the time of an `after` or `at`, or done or error for an end.
    """
    guard = " ".join(transition.guard.shown.split()) if transition.guard else ""
    if len(guard) > MAX_GUARD_LENGTH:
        guard = guard[: MAX_GUARD_LENGTH - 1].rstrip() + "…"
    return " ".join(filter(None, (transition.caption("error"), f"[{guard}]" if guard else "")))
