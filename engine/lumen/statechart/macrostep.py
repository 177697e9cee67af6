"""A macrostep: microsteps until nothing is enabled and the internal queue is empty (SCXML 3.13, `mainEventLoop`)."""

from lumen.statechart.execution_context import ExecutionContext
from lumen.statechart.microstep import count_microstep, microstep, take_enabled
from lumen.statechart.values import Step


def enter_machine(context: ExecutionContext) -> Step:
    """Enter the initial states, run the first macrostep (`interpret`), and return the step."""
    microstep(context, context.machine.planner.beginning())
    return complete(context)


def exit_machine(context: ExecutionContext) -> Step:
    """Exit every state of a machine that ends, and return the step; its events are ignored (`exitInterpreter`)."""
    microstep(context, context.machine.planner.end(context.configuration))
    return context.step()


def complete(context: ExecutionContext) -> Step:
    """Run the macrostep to its end and return the step.

    Invoked behaviours that still run receive the event from outside first. Then the entered states start their
    invocations and `do`, and finally the events that the machine sent are delivered.
    """
    while True:
        _macrostep(context)
        if context.unforwarded:
            event, context.unforwarded = context.unforwarded, None
            context.invocations.forward(context, event)
        elif context.beginnings:
            _begin(context)
        elif context.outbox:
            context.invocations.post(context)
        else:
            return context.step()


def _macrostep(context: ExecutionContext) -> None:
    """Take eventless transitions, then internal events, until there are none."""
    while True:
        if context.configuration.eventless and take_enabled(context, context.configuration.eventless):
            continue
        if not context.internal_queue:
            return
        count_microstep(context)
        event = context.take_internal()
        take_enabled(context, context.configuration.candidates(event.name))


def _begin(context: ExecutionContext) -> None:
    """Start the invocations and `do` of every state that was entered and not left, in document order."""
    beginnings, context.beginnings = sorted(context.beginnings, key=lambda beginning: beginning.node.index), ()
    for node, invokes, do, halted in beginnings:
        for invoke in invokes:
            context.invocations.begin(context, node, invoke)
        if do:
            context.activities.begin(context, node, halted)
