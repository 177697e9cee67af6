"""The timers of `after` whose delay is computed: set when a state is entered, once its `entry` is done."""

from lumen.expressions import ExpressionError
from lumen.language.nanoseconds import nanoseconds
from lumen.statechart.action_context import ActionError
from lumen.statechart.chart import ComputedAfter, StateNode
from lumen.statechart.execution_context import ExecutionContext
from lumen.statechart.values import Timer


def begin_computed(context: ExecutionContext, node: StateNode) -> None:
    """Set the timers of a state that is entered."""
    for event, after in node.computed.items():
        if (delay := computed_delay(context, node, after)) is not None:
            due = nanoseconds(context.at) + delay
            context.timers = (*context.timers, Timer(event, due, delay, event, None, node.path, "after"))


def computed_delay(context: ExecutionContext, node: StateNode, after: ComputedAfter) -> int | None:
    """How long it is now [ns]; None where it is no duration, which is error.execution."""
    context.evaluate_in(node)
    try:
        return nanoseconds(after.length(context))
    except (ExpressionError, ActionError) as error:
        context.raise_error(str(error), after.where)
        return None
