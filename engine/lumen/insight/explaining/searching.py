"""The smallest change after which a transition is taken: proposed from its guard, proved by taking the step."""

from collections.abc import Callable, Iterator, Mapping
from itertools import combinations, islice, product
from typing import Any

from lumen.errors import LumenError
from lumen.expressions import Scope, parse_expression
from lumen.expressions.tree import Literal, walk
from lumen.insight.explaining.boundaries import boundaries
from lumen.insight.explaining.changes import ProposedChange, StepSituation
from lumen.insight.explaining.conditions import holds
from lumen.insight.explaining.tracing import Moment, retaken
from lumen.insight.explaining.words import prefix_of
from lumen.language.actions import Expression
from lumen.language.json_paths import with_value
from lumen.language.machines import MachineDefinition, Transition
from lumen.statechart.chart import StateNode
from lumen.statechart.nesting import entered_names
from lumen.statechart.type_checks import fits
from lumen.talk.hearing import said_in
from lumen.talk.sample_sentences import of_row

MAX_TRIED = 40
"""The maximum number of steps that are taken to find a change."""
MAX_EDITS = 1_000
"""The maximum number of sets of values with which a guard is evaluated."""

MAX_SAID = 24
"""The maximum number of sentences that are tried for a row of `hears`."""
_SAID = ("event", "data", "result")

Happens = Callable[[StepSituation], bool]
"""A function that returns whether the expected transition is taken in a situation."""


def taken(machine: MachineDefinition, owner: str, transition: Transition, goal: str) -> Happens:
    """Return a test of whether a step includes that transition of the behaviour `owner`, and enters `goal`.

    The goal is checked if it is given, because a transition to a history state can enter any of several states.
    """

    def happens(situation: StepSituation) -> bool:
        try:
            trace = retaken(machine, situation.snapshot, situation.event)
        except LumenError:
            return False
        entered = set(entered_names(trace.step)) if trace.step else set()
        return (not goal or goal in entered) and any(
            one is transition for step in trace.microsteps if step.moment.owner == owner for one in step.transitions
        )

    return happens


def smallest_change(
    moment: Moment,
    node: StateNode,
    wanted: Transition,
    others: tuple[Transition, ...],
    from_: StepSituation,
    happens: Happens,
) -> ProposedChange | None:
    """Return the change with the fewest edits after which `happens` is true; None if no such change was found.

    `others` are the transitions that precede `wanted`; a change may need to make their guards false.
    """
    proposals = islice(_proposals(moment, node, wanted, others, from_.owner), MAX_TRIED)
    return next((change for change in proposals if happens(from_.edited(change))), None)


def _proposals(
    moment: Moment, node: StateNode, wanted: Transition, others: tuple[Transition, ...], owner: str
) -> Iterator[ProposedChange]:
    """Yield edits after which the guard holds, the fewest first; the data of the event comes before the context.

    At most MAX_EDITS are evaluated.
    """
    definition, checks = moment.machine.chart.definition, moment.machine.chart.checks
    scope = moment.scope_of(node)
    guards = [t.guard.source for t in (wanted, *others) if t.guard]
    values = boundaries(definition, guards, scope)
    if wanted.hears:
        said = islice(of_row(definition, wanted.hears, scope.context, literals_in(wanted.guard)), MAX_SAID)
        values[_SAID] = [
            text for text in dict.fromkeys((*said, *values.get(_SAID, ()))) if text != said_in(scope.event)
        ]
    values = {
        path: [v for v in found if path[0] == "event" or len(path) > 2 or fits(v, checks.get(path[1]))]
        for path, found in values.items()
    }
    paths = sorted((p for p in values if values[p]), key=lambda path: path[0] != "event")
    left = MAX_EDITS
    for count in (1, 2, 3):
        for chosen in combinations(paths, count):
            for given in product(*(values[path] for path in chosen)):
                left -= 1
                if left < 0:
                    return
                edits = dict(zip(chosen, given, strict=True))
                if holds(wanted.guard, edited_scope(scope, edits)):
                    yield {_name(path, owner): value for path, value in edits.items()}


def literals_in(guard: Expression | None) -> list[Any]:
    """Return the literals of a guard, and the neighbours of each integer."""
    found = [n.value for n, _ in walk(parse_expression(guard.source)) if isinstance(n, Literal)] if guard else []
    return [beside for value in found for beside in ((value, value + 1, value - 1) if type(value) is int else (value,))]


def edited_scope(scope: Scope, edits: Mapping[tuple[str, ...], Any]) -> Scope:
    """Return the scope with other values at these paths, which begin with `context` or `event`."""
    seen: dict[str, Any] = {"context": scope.context, "event": scope.event}
    for path, value in edits.items():
        seen = with_value(seen, path, value)
    return scope._replace(context=seen["context"], event=seen["event"])


def _name(path: tuple[str, ...], owner: str) -> str:
    return (prefix_of(owner) if path[0] == "context" else "") + ".".join(path)
