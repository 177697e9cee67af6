"""What stands at an arrow of a diagram."""

from lumen.language.machines import Invoke, Transition

MAX_GUARD_LENGTH = 32
"""How many characters of a guard are shown."""


def invocation(invoke: Invoke) -> str:
    """`quiz`, or `first: quiz` where it has an id of its own."""
    return invoke.behavior if invoke.id == invoke.behavior else f"{invoke.id}: {invoke.behavior}"


def caption(transition: Transition) -> str:
    """`event [guard]`; a row of `hears` with its key, an `after` or `at` with its time, an end as done or error."""
    guard = " ".join(transition.guard.shown.split()) if transition.guard else ""
    if len(guard) > MAX_GUARD_LENGTH:
        guard = guard[: MAX_GUARD_LENGTH - 1].rstrip() + "…"
    return " ".join(filter(None, (transition.caption("error"), f"[{guard}]" if guard else "")))
