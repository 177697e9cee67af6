"""Rows of `hears` in charts of other tools: they become conditions with a name of Lumen's, since no other tool has
them.
"""

from collections.abc import Sequence

from lumen.language.actions import Expression
from lumen.language.machines import Hears, Transition
from lumen.talk.hearing import ENTRY

LOST_ELSEWHERE = "implement this guard in the other tool: the longest match, negation, questions and captured values"
"""The hint of a finding about a row of `hears`: what is lost."""
HEARD_TEXT = "event.data.result"


def in_asked_order(transitions: Sequence[Transition]) -> Sequence[Transition]:
    """Return the transitions in the order of their evaluation.

    Rows of `hears` come after `on`, and before a transition on any event (`*`).
    """
    if not any(t.hears for t in transitions):
        return transitions
    return sorted(transitions, key=lambda t: 2 if t.event == "*" else t.hears is not None)


def key_of(row: Hears) -> str:
    """Return the key of a row, as in a behaviour file; empty if its phrases come from an entry of a `for`.

    A chart has no `for`, so a key with its variable would have no meaning.
    """
    return "" if any(name.startswith(ENTRY) for name in row.names) else row.title.removeprefix("hears ")


def as_guard(transition: Transition) -> Expression | None:
    """Return a row and its own guard as one guard; None for `not`, `asked` and `else`, which expressions lack."""
    row, guard = transition.hears, transition.guard
    if row is None or row.way:
        return None
    asked = [f"heard({HEARD_TEXT}, {name if name.startswith(ENTRY) else repr(name)})" for name in row.names]
    source = " || ".join(asked)
    return Expression(f"({source}) && ({guard.source})" if guard else source, transition.where)
