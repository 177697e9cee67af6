"""Dispatches events from outside: ended timers, the robot's answers, and everything else."""

from collections.abc import Mapping

from lumen.language.controllers import CONTROLLER_EVENT
from lumen.language.events import CLOCK_SET, Event
from lumen.language.message_numbers import number
from lumen.language.shared import SHARED, SHARED_EVENT
from lumen.statechart.action_context import ActionError
from lumen.statechart.command_ids import CommandAnswer, answer_of, inner_id, result_of
from lumen.statechart.execution_context import ExecutionContext
from lumen.statechart.macrostep import complete
from lumen.statechart.microstep import take_enabled
from lumen.statechart.schedule_timers import schedule_timer, set_clock
from lumen.statechart.type_checks import fits
from lumen.statechart.values import Step, Timer, awaited


def process(context: ExecutionContext, event: Event) -> Step:
    """Process an event from the external queue up to the end of the macrostep, and return the step.

    Behaviours that were invoked before receive it after the machine itself. Those that the machine ends because of the
    event do not receive it.
    """
    if event.sendid:
        _end_timer(context, event)
    elif ".command." in event.name and (answer := answer_of(event)):
        _answer(context, event, answer)
    else:
        if event.name.startswith(CONTROLLER_EVENT):
            _become(context, event)
        elif event.name == SHARED_EVENT:
            _learn(context, event)
        context.unforwarded = event if context.invocations.children else None
        take_enabled(context, context.configuration.candidates(event.name))
    return complete(context)


def _become(context: ExecutionContext, event: Event) -> None:
    """Assign the values of a fuzzy controller to the context before any transition is selected; skip unknown keys.

    A number of the wrong type is rounded to an integer; if that does not fit either, the key keeps its value and
    error.execution is raised.
    """
    for key, value in event.data.items() if isinstance(event.data, Mapping) else ():
        if key not in context.machine.chart.definition.context or number(value) is None:
            continue
        check = context.machine.chart.checks.get(key)
        try:
            context.assign(key, value if fits(value, check) else round(value))
        except ActionError as error:
            context.raise_error(str(error), ("context", key))


def _learn(context: ExecutionContext, event: Event) -> None:
    """Assign shared values of other robots to the context before any transition is selected; skip unknown keys.

    A value of the wrong type raises error.execution.
    """
    known = context.machine.chart.definition.shared
    news = {key: value for key, value in event.data.items() if key in known} if isinstance(event.data, Mapping) else {}
    if news:
        try:
            context.assign(SHARED, {**context.data[SHARED], **news})
        except ActionError as error:
            context.raise_error(str(error), ("context", SHARED))


def _end_timer(context: ExecutionContext, event: Event) -> None:
    """Handle a timer that ended, of this machine or an invoked behaviour; ignore one that was cancelled."""
    ended = [t for t in context.timers if t.id == event.sendid and t.event == event.name]
    if not ended:
        if event.name == event.sendid == CLOCK_SET:
            set_clock(context, event)
            return
        id, owner = inner_id(event.sendid)
        if owner in context.invocations.children:
            context.invocations.deliver(context, owner, event._replace(sendid=id))
        return
    timer = min(ended, key=lambda t: t.due_ns)
    context.timers = _without(context.timers, timer)
    if timer.kind == "at":
        node = context.machine.chart.nodes[timer.state]
        again = schedule_timer(context, node, timer.event, timer)
        context.timers = (*context.timers, again) if again else context.timers
    if timer.kind in ("after", "at"):
        take_enabled(context, context.configuration.timed(timer.event))
    elif timer.to:
        context.hand_over(timer.to, event._replace(sendid=""))
    elif timer.kind == "send":
        take_enabled(context, context.configuration.candidates(event.name))
    elif timer.id in awaited(context.activities.positions.get(timer.state)):
        context.activities.resume(context, context.machine.chart.nodes[timer.state], timer.id)


def _answer(context: ExecutionContext, event: Event, answer: CommandAnswer) -> None:
    """Handle the outcome of a command: the `do` that awaits it continues or fails; no transition sees the event."""
    kind, id, reason, data = answer
    own, owner = inner_id(id)
    if owner:
        _hand_down(context, event, kind, own, owner)
        return
    waiting = next((path for path, position in context.activities.positions.items() if id in awaited(position)), None)
    if waiting is not None:
        node = context.machine.chart.nodes[waiting]
        if kind == "answer":
            context.activities.answer(context, node, id, data)
        elif kind == "done" or context.activities.is_question(node, id):
            context.activities.resume(context, node, id, result_of(data))
        elif kind == "lost":
            context.activities.lose(context, node, id, reason)
        else:
            context.activities.fail(context, node, id, reason)
    elif kind in ("error", "lost") and id.startswith("c"):
        context.raise_event(Event("error.communication", {"command": id, "reason": reason}, context.at))


def _hand_down(context: ExecutionContext, event: Event, kind: str, id: str, owner: str) -> None:
    """Deliver an answer to the behaviour that started the command, unless a later behaviour runs under the same id."""
    child = context.invocations.children.get(owner)
    if child and not (id.startswith("c") and int(id[1:].partition("@")[0]) <= child.commands):
        context.invocations.deliver(context, owner, event._replace(name=f"{kind}.command.{id}"))


def _without(timers: tuple[Timer, ...], timer: Timer) -> tuple[Timer, ...]:
    index = next(i for i, t in enumerate(timers) if t is timer)
    return timers[:index] + timers[index + 1 :]
