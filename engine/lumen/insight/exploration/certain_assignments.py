"""Which context keys surely get new values: an expression may fail, and then the key keeps its old one."""

from collections.abc import Iterator

from lumen.expressions import ExpressionNode, names, unparse
from lumen.expressions.function_table import clock_functions
from lumen.expressions.functions import CAUGHT
from lumen.expressions.tree import Binary, FieldAccess, FunctionCall, Literal, Logic, Unary, children
from lumen.insight.exploration.expression_uses import tree_of
from lumen.language.actions import Assign, ComputedValue, Expression, PlacedAction, context_key
from lumen.language.machines import Transition


def assigned_on_entry(block: tuple[PlacedAction, ...]) -> frozenset[str]:
    """The keys that a block surely gives new values, whatever they were."""
    return frozenset(
        key
        for step in block
        if isinstance(step.action, Assign)
        for key, value in step.action.values.items()
        if context_key(key) == key and _certain(value)
    )


def assigned_by(transition: Transition, caught: frozenset[str] = frozenset()) -> frozenset[str]:
    """The keys that its actions surely give new values: up to the first action that may fail.

    What its guard has computed from the event, which it has if it is true, can be computed again. `caught` is what
    `heard` surely has there.
    """
    guard = tree_of(transition.guard.source) if transition.guard else None
    known = {unparse(node) for node in _computed(guard)} if guard else set()
    found: set[str] = set()
    for step in transition.actions:
        if not isinstance(step.action, Assign):
            break
        for key, value in step.action.values.items():
            if not (_certain(value) or (isinstance(value, Expression) and _again(value, known, caught))):
                return frozenset(found)
            if context_key(key) == key:
                found.add(key)
    return frozenset(found)


def _certain(value: ComputedValue) -> bool:
    """Whether a value can be had without fail: an expression may have none."""
    return not isinstance(value, Expression) or isinstance(tree_of(value.source), Literal)


def _again(value: Expression, known: set[str], caught: frozenset[str]) -> bool:
    match tree := tree_of(value.source):
        case FunctionCall("in_language", (FieldAccess(FunctionCall(function), name),)) if function == CAUGHT:
            return name in caught
    return tree is not None and unparse(tree) in known


def _computed(tree: ExpressionNode) -> Iterator[ExpressionNode]:
    """The parts of a true guard that it has surely computed, and that come to the same for the same event."""
    speaks = names(tree)
    if not speaks.context and not speaks.functions & {"In", *clock_functions()}:
        yield tree
    match tree:
        case Binary() | Unary() | Logic(sign="&&"):  # the other sign takes an error for false
            parts = tuple(children(tree))
        case FunctionCall(function=function) if function != "has":
            parts = tuple(children(tree))
        case _:
            parts = ()
    for part in parts:
        yield from _computed(part)
