"""The events that a language model may raise now: those of transitions marked as an `offer`."""

from typing import Any

from lumen.expressions import ExpressionError, Scope, compile_guard
from lumen.expressions.scope import no_draw
from lumen.language.machines import MachineDefinition
from lumen.statechart.compiled_machine import compiled
from lumen.statechart.values import Snapshot


def offers(machine: MachineDefinition, snapshot: Snapshot) -> dict[str, Any]:
    """Return the events offered by transitions of active states, each with the JSON Schema of its data.

    Transitions that need a person's approval are left out. Guards must be true now, but one that reads the event counts
    as true, because it can't be evaluated before the event arrives.
    """
    standing = compiled(machine).planner.configuration(snapshot.configuration)
    found: dict[str, Any] = {}
    for node in dict.fromkeys(n for leaf in standing.leaves for n in (leaf, *leaf.ancestors)):
        scope = Scope(
            snapshot.context, None, node.view(snapshot.language, snapshot.place), standing.known.__contains__,
            snapshot.at, snapshot.language, machine.phrases, machine.answers, snapshot.epoch, snapshot.timezone,
            machine.lists, no_draw, machine,
        )  # fmt: skip
        for one in (transition.definition for transition in node.transitions):
            if one.offer and not one.approve and (one.guard is None or _may_hold(one.guard.source, scope)):
                found[one.event] = machine.events.get(one.event) or {}
    return found


def _may_hold(guard: str, scope: Scope) -> bool:
    if "event" in guard:
        return True
    try:
        return bool(compile_guard(guard)(scope))
    except ExpressionError:
        return False
