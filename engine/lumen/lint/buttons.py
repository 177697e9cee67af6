"""Buttons: whether pressing a button has an effect, and whether two buttons share a key."""

from collections.abc import Iterator

from lumen.language.buttons import Button
from lumen.language.diagnostics import WARNING, Code, did_you_mean
from lumen.language.machines import MachineDefinition, State, StateKind
from lumen.lint.events import descriptors, hears
from lumen.lint.logic import never, tree
from lumen.project.document_report import DocumentReport
from lumen.project.draft import ProjectDraft

DEAD_BUTTON = Code(
    "dead-button", "statecharts", WARNING, "a button raises an event that nothing waits for while the button is shown"
)
SHARED_BUTTON_KEY = Code(
    "shared-button-key", "statecharts", WARNING, "two buttons that are shown together have the same key"
)


def check(draft: ProjectDraft) -> None:
    """Report buttons that no active state reacts to, and keys that belong to two buttons shown together."""
    for name, machine in draft.behaviors.items():
        placed = [(state, button) for state in machine.states.values() for button in state.buttons]
        report = draft.report("behaviors", name)
        others = tuple(_around(draft, name))[1:] if placed else ()
        for state, button in placed:
            if report.whole and not _answered(machine, state, button.event, others):
                _dead(button, (machine, *others), report)
        for number, (state, button) in enumerate(placed):
            rivals = (other for other in placed[:number] if _collide(machine, (state, button), other))
            if rival := next(rivals, None):
                message = f"the key `{button.key}` also belongs to {_shown(rival[1])}, which is shown at the same time"
                related = [((*rival[1].where, "key"), "the other button with this key")]
                report(
                    SHARED_BUTTON_KEY, (*button.where, "key"), message, "give this button another key", related=related
                )


def _dead(button: Button, machines: tuple[MachineDefinition, ...], report: DocumentReport) -> None:
    event = button.event
    waited = {descriptor for machine in machines for descriptor in descriptors(machine)}
    known = {descriptor for descriptor in waited if "*" not in descriptor}
    if any(hears(descriptor, event) for descriptor in waited):
        message = f"{_shown(button)} can't be pressed: while it is shown, no active state waits for `{event}`"
        hint = "move it to a state that waits for the event, or handle the event here under `on`"
    else:
        message = f"nothing waits for the event `{event}` of {_shown(button)}"
        hint = did_you_mean(event, known)
        hint = hint if "mean" in hint else "handle it under `on:`, or delete the button"
    report(DEAD_BUTTON, (*button.where, "event"), message, hint)


def _answered(machine: MachineDefinition, state: State, event: str, others: tuple[MachineDefinition, ...]) -> bool:
    """Return whether a state that is active together with `state`, or another behaviour, reacts to the event."""
    if any(hears(d, event) for other in others for d in descriptors(other)):
        return True
    return any(
        not (t.guard and never(tree(t.guard.source)))
        for other in machine.states.values()
        if together(machine, state, other)
        for t in other.transitions
        if t.event and not t.exact and hears(t.event, event)
    )


def _around(draft: ProjectDraft, name: str) -> Iterator[MachineDefinition]:
    """Yield this behaviour, then those that can run with it because either invokes the other, even indirectly."""
    invoked = {other: set(_invoked(machine)) for other, machine in draft.behaviors.items()}
    found = [name]
    for one in found:
        near = {*invoked.get(one, ()), *(host for host, inner in invoked.items() if one in inner)}
        found += sorted(near - set(found))
    yield from (draft.behaviors[one] for one in found if one in draft.behaviors)


def _invoked(machine: MachineDefinition) -> Iterator[str]:
    yield from (invoke.behavior for state in machine.states.values() for invoke in state.invoke)


def together(machine: MachineDefinition, one: State, other: State) -> bool:
    """Return whether two states can be active together: either contains the other, or their regions differ."""
    around, beside = _line(machine, one), _line(machine, other)
    common = next(path for path in around if path in beside)
    return common in (one.path, other.path) or machine.states[common].kind is StateKind.PARALLEL


def _line(machine: MachineDefinition, state: State) -> list[str]:
    """Return the paths of a state and its ancestors, from the inside out."""
    found = [state.path]
    while (parent := machine.states[found[-1]].parent) is not None:
        found.append(parent)
    return found


def _collide(machine: MachineDefinition, one: tuple[State, Button], other: tuple[State, Button]) -> bool:
    """Return whether two buttons with the same key are shown together; an inner state's button replaces outer ones."""
    if not one[1].key or one[1].key != other[1].key:
        return False
    inside = one[0].path in _line(machine, other[0]) or other[0].path in _line(machine, one[0])
    return one[0] is other[0] or (not inside and together(machine, one[0], other[0]))


def _shown(button: Button) -> str:
    return f"“{next(iter(button.label.values()))}”"
