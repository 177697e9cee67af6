"""Converts event descriptors between Lumen and XState, which matches names exactly and tries the longest first."""

import re
from collections.abc import Iterator, Sequence
from itertools import pairwise

from lumen.features.formats_charts.heard_rows import in_asked_order
from lumen.language.actions import AskQuestion, If, PlacedAction, Raise, Send
from lumen.language.machines import MachineDefinition, State, Transition

_OWN_EVENTS = {
    "xstate.done.state.": "done.state.",
    "done.state.": "done.state.",
    "xstate.done.actor.": "done.invoke.",
    "done.invoke.": "done.invoke.",
    "xstate.error.actor.": "error.invoke.",
    "error.platform.": "error.invoke.",
}
"""Lumen's prefixes for XState's own events, by the prefixes in versions 5 and 4."""

_DESCRIPTOR = re.compile(r"\*|[^\s.*]+(\.[^\s.*]+)*(\.\*)?")


def is_descriptor(text: str) -> bool:
    """Return whether a text is a valid key of `on`."""
    return bool(_DESCRIPTOR.fullmatch(text))


def own_event(event: str) -> tuple[str, str] | None:
    """Return Lumen's prefix for one of XState's own events, and the id after it; None for any other event."""
    for begin, ours in _OWN_EVENTS.items():
        if event.startswith(begin) and (id := event.removeprefix(begin)):
            return ours, id
    return None


def invoke_id(id: str) -> str:
    """Return an invocation's id in a form that is valid at the end of an event's name."""
    return ".".join(word for word in re.sub(r"[\s*]+", "_", id).split(".") if word) or "_"


class EventDescriptors:
    """Converts the descriptors of one machine to XState's form and order."""

    def __init__(self, machine: MachineDefinition) -> None:
        self.names = set(machine.events)
        self.wild: set[str] = set()
        for state in machine.states.values():
            for block in (state.entry, state.exit, state.do, *(t.actions for t in state.transitions)):
                self.names.update(_raised(block))
            written = [t.event for t in state.transitions if t.event not in ("", "*") and not t.exact]
            self.names.update(map(bare, written))
            self.wild.update(bare(event) for event in written if event.endswith(".*"))

    def arranged(self, state: State) -> dict[str, list[Transition]]:
        """Return a state's candidates by XState's descriptors, longest first if the order matters.

        The state's own events have keys such as `!done.do.a`. A more general candidate that Lumen tries before a
        specific one is repeated under the specific descriptor, because XState would try it later.
        """
        rows = [t for t in in_asked_order(state.transitions) if t.event and not t.timed]
        table: dict[str, list[Transition]] = {}
        for transition in rows:
            table.setdefault(self._named(transition), [])
        for descriptor in table:
            last = max(i for i, t in enumerate(rows) if self._named(t) == descriptor)
            event = bare(descriptor.removeprefix("!"))
            found = [t for t in rows[: last + 1] if self._named(t) == descriptor or (_covers(t, event) and not t.hears)]
            table[descriptor] = found
        keys = list(table)
        if _rivals(keys):
            keys = longest_first(sorted(keys, key=lambda d: (d == "*", -len(bare(d)))))
        return {key: table[key] for key in keys}

    def _named(self, transition: Transition) -> str:
        event = transition.event
        if transition.exact or event == "*" or event.endswith(".*"):
            return f"!{event}" if transition.exact else event
        return f"{event}.*" if event in self.wild or any(name.startswith(f"{event}.") for name in self.names) else event


def bare(descriptor: str) -> str:
    """Return `a` for `a.*`, and any other descriptor unchanged."""
    return descriptor.removesuffix(".*")


def longest_first(descriptors: Sequence[str]) -> list[str]:
    """Return descriptors in XState's order, longest first, if an event can match two of them; else unchanged."""
    return sorted(descriptors, key=lambda d: (d == "*", -len(d))) if _rivals(descriptors) else list(descriptors)


def _rivals(descriptors: Sequence[str]) -> bool:
    """Return whether an event can match two of the descriptors, by comparing neighbours in alphabetical order."""
    names = sorted(f"{bare(descriptor)}." for descriptor in descriptors)
    return ("*." in names and len(names) > 1) or any(b.startswith(a) for a, b in pairwise(names))


def _covers(transition: Transition, event: str) -> bool:
    """Return whether the transition matches `event` and every event below it."""
    if transition.exact:
        return False
    general = bare(transition.event)
    return general == "*" or f"{event}.".startswith(f"{general}.")


def _raised(steps: Sequence[PlacedAction]) -> Iterator[str]:
    for step in steps:
        match step.action:
            case Raise(event) | Send(event, to=""):
                yield event
            case AskQuestion(otherwise=otherwise):
                yield from _raised(otherwise)
            case If(_, then, otherwise):
                yield from _raised(then)
                yield from _raised(otherwise)
