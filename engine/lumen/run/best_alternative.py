"""The choice among a recogniser's alternative texts: the first that would trigger a transition by phrases.

The choice is made before the step, so that the journal records the chosen text.
"""

from collections.abc import Iterator
from functools import lru_cache
from itertools import islice
from typing import Any

from lumen.errors import LumenError
from lumen.expressions.parser import parse_expression
from lumen.expressions.tree import ExpressionNode, FunctionCall, Unary, children
from lumen.language.events import Event
from lumen.language.machines import MachineDefinition
from lumen.language.routes import HEARD
from lumen.statechart import Snapshot, Step, step

MAX_ALTERNATIVES = 10
"""The number of alternatives that are tried, including the recogniser's first result."""
_COMPARES = frozenset(("heard", "lookup"))


def best_alternative(machine: MachineDefinition, snapshot: Snapshot, event: Event) -> Event:
    """Return a `heard` event with the first text that triggers a transition which depends on phrases.

    The event is returned unchanged if it has no alternatives, or no text triggers such a transition. Steps are only
    tried, not taken.
    """
    data = event.data
    if event.name != HEARD or not isinstance(data, dict) or not isinstance(data.get("alternatives"), list):
        return event
    for text in islice(_texts(data), MAX_ALTERNATIVES):
        heard = event._replace(data={**data, "result": text})
        try:
            if _means_something(step(machine, snapshot, heard)):
                return heard
        except LumenError:
            continue  # the real step reports the error
    return event


def _texts(data: dict[str, Any]) -> Iterator[str]:
    """Yield the most likely text, then the alternatives."""
    for row in (data, *data["alternatives"]):
        if isinstance(row, dict) and isinstance(row.get("result"), str):
            yield row["result"]


def _means_something(taken: Step) -> bool:
    if any(transition.hears and transition.hears.way != "else" for transition in taken.transitions):
        return True
    guards = (transition.guard for transition in taken.transitions)
    if any(guard is not None and _asks_for_phrases(guard.source) for guard in guards):
        return True
    return any(_means_something(inner) for _, inner in taken.invoked)


@lru_cache(maxsize=1000)
def _asks_for_phrases(guard: str) -> bool:
    """Return whether a guard calls `heard` or `lookup` outside a negation."""
    return _compares(parse_expression(guard))


def _compares(node: ExpressionNode) -> bool:
    match node:
        case FunctionCall(function) if function in _COMPARES:
            return True
        case Unary("!"):
            return False
    return any(_compares(child) for child in children(node))
