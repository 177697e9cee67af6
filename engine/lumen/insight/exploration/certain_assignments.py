"""The context keys that certainly get new values: if an expression fails, its key keeps the old one."""

from collections.abc import Iterator

from lumen.expressions import ExpressionNode, names, unparse
from lumen.expressions.function_table import clock_functions
from lumen.expressions.functions import CAUGHT
from lumen.expressions.tree import Binary, FieldAccess, FunctionCall, Literal, Logic, Unary, children
from lumen.insight.exploration.expression_uses import tree_of
from lumen.language.actions import Assign, ComputedValue, Expression, PlacedAction, context_key
from lumen.language.machines import Transition


def assigned_on_entry(block: tuple[PlacedAction, ...]) -> frozenset[str]:
    """Return the keys that a block certainly gives new values that do not depend on the old ones."""
    return frozenset(
        key
        for step in block
        if isinstance(step.action, Assign)
        for key, value in step.action.values.items()
        if context_key(key) == key and _certain(value)
    )


def assigned_by(transition: Transition, caught: frozenset[str] = frozenset()) -> frozenset[str]:
    """Return the keys that a transition's actions certainly give new values, up to the first action that may fail.

    An expression that the guard has evaluated from the event alone can't fail later: the guard was true. `caught` are
    the keys that `heard` certainly has there.
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
    """Return whether a value is certain: an expression, unless it is a literal, may fail."""
    return not isinstance(value, Expression) or isinstance(tree_of(value.source), Literal)


def _again(value: Expression, known: set[str], caught: frozenset[str]) -> bool:
    match tree := tree_of(value.source):
        case FunctionCall("in_language", (FieldAccess(FunctionCall(function), name),)) if function == CAUGHT:
            return name in caught
    return tree is not None and unparse(tree) in known


def _computed(tree: ExpressionNode) -> Iterator[ExpressionNode]:
    """Yield the parts of a true guard that were certainly evaluated and have the same value for the same event."""
    speaks = names(tree)
    if not speaks.context and not speaks.functions & {"In", *clock_functions()}:
        yield tree
    match tree:
        case Binary() | Unary() | Logic(sign="&&"):  # `||` counts an error as false, so an operand may have failed
            parts = tuple(children(tree))
        case FunctionCall(function=function) if function != "has":
            parts = tuple(children(tree))
        case _:
            parts = ()
    for part in parts:
        yield from _computed(part)
