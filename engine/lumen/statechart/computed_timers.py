"""Timers of `after` with computed delays: set when a state is entered, after its `entry` actions."""

from lumen.expressions import ExpressionError
from lumen.language.nanoseconds import nanoseconds
from lumen.statechart.action_context import ActionError
from lumen.statechart.chart import ComputedAfter, StateNode
from lumen.statechart.execution_context import ExecutionContext
from lumen.statechart.values import Timer


def begin_computed(context: ExecutionContext, node: StateNode) -> None:
    """Set the computed timers of a state that is entered."""
    for event, after in node.computed.items():
        if (delay := computed_delay(context, node, after)) is not None:
            due = nanoseconds(context.at) + delay
            context.timers = (*context.timers, Timer(event, due, delay, event, None, node.path, "after"))


def computed_delay(context: ExecutionContext, node: StateNode, after: ComputedAfter) -> int | None:
    """Return the delay as computed now [ns]; if it is not a duration, raise error.execution and return None."""
    context.evaluate_in(node)
    try:
        return nanoseconds(after.length(context))
    except (ExpressionError, ActionError) as error:
        context.raise_error(str(error), after.where)
        return None
