"""The expressions that decide a behaviour's course, state by state."""

from collections.abc import Iterable, Iterator, Mapping
from functools import lru_cache
from typing import NamedTuple

from lumen.expressions import ExpressionError, ExpressionNode, names, parse_expression, split_template
from lumen.language.actions import (
    AskQuestion,
    Assign,
    ComputedValue,
    Expression,
    If,
    Parallel,
    PlacedAction,
    Raise,
    Send,
    Template,
    context_key,
)
from lumen.language.machines import MachineDefinition, State, Transition
from lumen.language.properties import Property, conditions_of
from lumen.talk.hearing import ENTRY


class ExpressionUse(NamedTuple):
    """An expression, and the context key to which its value is assigned."""

    tree: ExpressionNode
    key: str = ""
    """The context key that gets the value; empty if the value decides the behaviour's course."""


@lru_cache(maxsize=8192)
def tree_of(source: str) -> ExpressionNode | None:
    """Return the tree of an expression; None if it is malformed."""
    try:
        return parse_expression(source)
    except ExpressionError:
        return None


def property_trees(properties: Iterable[Property]) -> Iterator[ExpressionNode]:
    """Yield the conditions of properties as trees."""
    yield from filter(None, (tree_of(condition.source) for condition in conditions_of(properties)))


def of_transition(transition: Transition) -> Iterator[ExpressionUse]:
    """Yield the expressions of a transition: phrases in a list's entry, guard, delay, and those of its actions."""
    if transition.hears:
        yield from (use for name in transition.hears.names if name.startswith(ENTRY) for use in _of(Expression(name)))
    if transition.guard:
        yield from _of(transition.guard)
    yield from _of_delay(transition.delay)
    yield from of_block(transition.actions)


def of_state(state: State) -> Iterator[ExpressionUse]:
    """Yield the expressions of a state, including those of its transitions."""
    for block in (state.entry, state.do, state.exit):
        yield from of_block(block)
    for transition in state.transitions:
        yield from of_transition(transition)
    for value in (state.output, *(invoke.input for invoke in state.invoke)):
        yield from _of(value)


def of_block(block: tuple[PlacedAction, ...]) -> Iterator[ExpressionUse]:
    """Yield the expressions of actions, except in texts and messages, which change nothing in the behaviour."""
    for step in block:
        match step.action:
            case If(guard, then, otherwise):
                yield from _of(guard)
                yield from of_block(then + otherwise)
            case Parallel(branches) | AskQuestion(otherwise=branches):
                yield from of_block(branches)
            case Assign(values):
                for way, value in values.items():
                    yield from _of(value, context_key(way))
                    if (key := context_key(way)) != way:  # the other keys of the map stay, so its old value is read
                        yield from _of(Expression(f"context.{key}"), key)
            case Send(data=data, delay=delay):
                yield from _of(data)
                yield from _of_delay(delay)
            case Raise(data=data):
                yield from _of(data)


def relevant(machine: MachineDefinition) -> frozenset[str]:
    """Return the context keys that the behaviour's course depends on, directly or through other keys."""
    uses = [use for state in machine.states.values() for use in of_state(state)]
    found: set[str] = set()
    while True:
        read = {key for use in uses if not use.key or use.key in found for key in names(use.tree).context}
        if read <= found:
            return frozenset(found)
        found |= read


def _of_delay(delay: float | Template | None) -> Iterator[ExpressionUse]:
    if isinstance(delay, Template):
        holes = (part for part in split_template(delay.text) if not isinstance(part, str))
        yield from (use for hole in holes for use in _of(Expression(hole.source)))


def _of(value: ComputedValue, key: str = "") -> Iterator[ExpressionUse]:
    if isinstance(value, Expression):
        if (tree := tree_of(value.source)) is not None:
            yield ExpressionUse(tree, key)
    elif isinstance(value, Mapping):
        for item in value.values():
            yield from _of(item, key)
    elif isinstance(value, tuple):
        for item in value:
            yield from _of(item, key)
