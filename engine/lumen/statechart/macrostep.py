"""A macrostep: microsteps until nothing is enabled and the internal queue is empty (SCXML 3.13, `mainEventLoop`)."""

from lumen.statechart.execution_context import ExecutionContext
from lumen.statechart.microstep import count_microstep, microstep, take_enabled
from lumen.statechart.values import Step


def enter_machine(context: ExecutionContext) -> Step:
    """Enter the initial states, and all that follows from it (`interpret`)."""
    microstep(context, context.machine.planner.beginning())
    return complete(context)


def exit_machine(context: ExecutionContext) -> Step:
    """Leave every state, for the machine is over; nobody hears what that raises (`exitInterpreter`)."""
    microstep(context, context.machine.planner.end(context.configuration))
    return context.step()


def complete(context: ExecutionContext) -> Step:
    """Go on until there is nothing more to do now.

    An event from outside comes to the invoked behaviours that run already and still do; then what was entered begins,
    and in the end they hear what the machine sends to them.
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
    """Begin what every state entered and not left invokes and has to `do`, in document order."""
    beginnings, context.beginnings = sorted(context.beginnings, key=lambda beginning: beginning.node.index), ()
    for node, invokes, do, halted in beginnings:
        for invoke in invokes:
            context.invocations.begin(context, node, invoke)
        if do:
            context.activities.begin(context, node, halted)
