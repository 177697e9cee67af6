"""What the expressions of transitions and assignments refer to: `context`, `event`, `state`, `In`."""

from collections.abc import Iterable, Iterator, Mapping

from lumen.interpreters.expressions import parse_expression
from lumen.interpreters.expressions.tree import FunctionCall, Identifier, walk
from lumen.language.actions import Assign, ComputedValue, Expression, PlacedAction
from lumen.language.machines import Transition


def referenced_names(sources: Iterable[str]) -> set[str]:
    """The names that these expressions refer to; of functions only `In`."""
    nodes = [node for source in set(sources) for node, _ in walk(parse_expression(source))]
    asks = any(isinstance(node, FunctionCall) and node.function == "In" for node in nodes)
    return {node.name for node in nodes if isinstance(node, Identifier)} | ({"In"} if asks else set())


def sources_of(transition: Transition) -> Iterator[str]:
    """The expressions of its guard, and of what it assigns."""
    if transition.guard:
        yield transition.guard.source
    yield from assigned_sources(transition.actions)


def assigned_sources(steps: Iterable[PlacedAction]) -> Iterator[str]:
    """The expressions of what these actions assign."""
    for step in steps:
        if isinstance(step.action, Assign):
            yield from _sources(tuple(step.action.values.values()))


def _sources(value: ComputedValue) -> Iterator[str]:
    match value:
        case Expression(source):
            yield source
        case tuple():
            for item in value:
                yield from _sources(item)
        case Mapping():
            for item in value.values():
                yield from _sources(item)
