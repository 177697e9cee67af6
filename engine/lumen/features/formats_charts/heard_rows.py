"""Converts rows of `hears`, which other tools lack, to conditions that only Lumen understands."""

from collections.abc import Sequence

from lumen.language.actions import Expression
from lumen.language.machines import Hears, Transition
from lumen.talk.hearing import ENTRY

LOST_ELSEWHERE = "implement this guard in the other tool: the longest match, negation, questions and captured values"
"""The hint for a converted row of `hears`, which lists the features that are lost."""
HEARD_TEXT = "event.data.result"


def in_asked_order(transitions: Sequence[Transition]) -> Sequence[Transition]:
    """Return the transitions in evaluation order.

    Rows of `hears` follow the other transitions, and precede those on any event (`*`).
    """
    if not any(t.hears for t in transitions):
        return transitions
    return sorted(transitions, key=lambda t: 2 if t.event == "*" else t.hears is not None)


def key_of(row: Hears) -> str:
    """Return a row's key in the behaviour file, or empty if its phrases come from a `for` entry.

    A chart has no `for`, so a key with the loop variable would be meaningless.
    """
    return "" if any(name.startswith(ENTRY) for name in row.names) else row.title.removeprefix("hears ")


def as_guard(transition: Transition) -> Expression | None:
    """Return a row's phrases and its own guard as one guard.

    Return None without a row, and for `not`, `asked` and `else`, which expressions lack.
    """
    row, guard = transition.hears, transition.guard
    if row is None or row.way:
        return None
    asked = [f"heard({HEARD_TEXT}, {name if name.startswith(ENTRY) else repr(name)})" for name in row.names]
    source = " || ".join(asked)
    return Expression(f"({source}) && ({guard.source})" if guard else source, transition.where)
