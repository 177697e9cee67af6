"""The buttons of the active states, and whether pressing each would have an effect now."""

from collections.abc import Iterator
from typing import NamedTuple

from lumen.errors import LumenError
from lumen.insight.explaining.names import machines_in
from lumen.insight.explaining.outlook import Running, running, ways_out
from lumen.insight.explaining.words import prefix_of
from lumen.language.buttons import Button
from lumen.language.causes import Cause
from lumen.language.diagnostics import did_you_mean
from lumen.language.events import Event
from lumen.language.machines import MachineDefinition
from lumen.statechart.compiled_machine import compiled
from lumen.statechart.stepping import step
from lumen.statechart.values import Snapshot, Step

MAX_NAMED_STATES = 3
"""The maximum number of states that a refusal names in which a button works."""


class ShownButton(NamedTuple):
    """A button of an active state."""

    button: Button
    """The button as the behaviour defines it."""
    state: str
    """The outside name of the button's state."""
    key: str
    """The button's key; empty if another shown button has the same key."""
    enabled: bool
    """Whether the button's event would be taken now."""
    reason: str
    """Why the event would not be taken; empty if it would."""


def shown_buttons(machine: MachineDefinition, snapshot: Snapshot, at: float) -> list[ShownButton]:
    """Return the buttons of all active states, and whether pressing each would have an effect at `at` [s].

    A behaviour comes before those that it invokes. Within it, the regions come in turn, each from the innermost state
    outwards. A button hides those of outer states that it replaces (`Button.replaces`).
    """
    found: list[ShownButton] = []
    keys: set[str] = set()
    for one in running(machine, snapshot):
        for state, button in _active(one):
            reason = refusal_of(machine, snapshot, button, at)
            key = "" if button.key in keys else button.key
            keys.add(key)
            found.append(ShownButton(button, state, key, not reason, reason))
    return found


def pressed(machine: MachineDefinition, snapshot: Snapshot, label: str, at: float, by: str) -> Event | str:
    """Return the event of the button with that label, in any language; a message if it can't be pressed."""
    shown = shown_buttons(machine, snapshot, at)
    found = sorted((one for one in shown if one.button.named(label)), key=lambda one: not one.enabled)
    if not found:
        labels = [text for one in shown for text in one.button.label.values()]
        return f"there is no button “{label}” now: {did_you_mean(label, labels, 'there are')}"
    if not found[0].enabled:
        return f"the button “{label}” can't be pressed: {found[0].reason}"
    button = found[0].button
    return Event(button.event, button.data, at, cause=Cause("person", f"the button “{label}”", sender=by))


def refusal_of(machine: MachineDefinition, snapshot: Snapshot, button: Button, at: float) -> str:
    """Return why pressing a button at `at` [s] would have no effect, in words for people; empty if it would."""
    event = Event(button.event, button.data, at)
    try:
        if takes(step(machine, snapshot, event)):
            return ""
    except LumenError as error:
        return str(error)
    closed = next((way.why for way in ways_out(machine, snapshot, at, event) if not way.open), "")
    return closed or _elsewhere(machine, button.event)


def takes(step: Step) -> bool:
    """Return whether a step has transitions, in its machine or in an invoked behaviour."""
    return bool(step.transitions) or any(takes(inner) for _, inner in step.invoked)


def _active(one: Running) -> Iterator[tuple[str, Button]]:
    """Yield each button of a running behaviour once, with the name of its state."""
    configuration = compiled(one.machine).planner.configuration(one.snapshot.configuration)
    seen: set[str] = set()
    if configuration.finished:
        return
    for leaf in configuration.leaves:
        above: list[Button] = []
        for node in (leaf, *leaf.ancestors):
            own = node.state.buttons if node.state else ()
            shown = [button for button in own if not any(inner.replaces(button) for inner in above)]
            if node.path not in seen:
                yield from ((one.prefix + (node.name or one.machine.id), button) for button in shown)
            seen.add(node.path)
            above += own


def _elsewhere(machine: MachineDefinition, event: str) -> str:
    """Return which states accept the event, in words."""
    names = [
        prefix_of(owner) + (node.name or inner.id)
        for owner, inner in machines_in(machine)
        for node in compiled(inner).chart.nodes.values()
        if any(transition.matches(event) for transition in node.transitions)
    ]
    if not names:
        return f"no state waits for {event}"
    more = f", and {len(names) - MAX_NAMED_STATES} more" if len(names) > MAX_NAMED_STATES else ""
    return f"only in {', '.join(names[:MAX_NAMED_STATES])}{more}"
