"""The timers of `at`: set on entry and each time that they end, and adjusted if the clock is set.

Such a timer waits for a moment of the wall clock, so its delay is computed when it is set.
"""

from lumen.expressions.wall_clock import moment, next_moment, readjusted
from lumen.language.events import Event
from lumen.language.hours import Schedule
from lumen.language.nanoseconds import nanoseconds
from lumen.statechart.chart import StateNode
from lumen.statechart.execution_context import ExecutionContext
from lumen.statechart.values import Timer


def begin_schedules(context: ExecutionContext, node: StateNode) -> None:
    """Set a timer for the next moment of each `at` of a state."""
    timers = (schedule_timer(context, node, event) for event in node.schedules)
    context.timers = (*context.timers, *filter(None, timers))


def schedule_timer(context: ExecutionContext, node: StateNode, event: str, ended: Timer | None = None) -> Timer | None:
    """Return the timer for the next moment of an `at`, from now or from when it `ended`; None if no day is left."""
    now = moment(context.epoch, context.at)
    after = max(now, moment(context.epoch, ended.due)) if ended else now
    found = next_moment(node.schedules[event], after, context.timezone)
    return None if found is None else _timer(context, node.path, event, found)


def set_clock(context: ExecutionContext, event: Event) -> None:
    """Adjust all `at` timers, also of invoked behaviours, after the wall clock or its time zone was set."""
    was = event.data.get("was", {"epoch": context.epoch, "timezone": context.timezone})
    before, now = moment(was["epoch"], context.at), moment(event.data["epoch"], context.at)
    moved = was["timezone"] != event.data["timezone"]
    context.epoch, context.timezone, context.cached_scope = event.data["epoch"], event.data["timezone"], None
    timers: list[Timer] = []
    for timer in context.timers:
        if timer.kind != "at":
            timers.append(timer)
            continue
        schedule = _schedule(context, timer)
        due = moment(was["epoch"], timer.due)
        zone = context.timezone
        found = next_moment(schedule, now, zone) if moved else readjusted(due, schedule, before, now, zone)
        if found is not None:
            timers.append(_timer(context, timer.state, timer.event, found))
    context.timers = tuple(timers)
    context.invocations.forward(context, event._replace(data={**event.data, "was": was}))


def _schedule(context: ExecutionContext, timer: Timer) -> Schedule:
    return context.machine.chart.nodes[timer.state].schedules[timer.event]


def _timer(context: ExecutionContext, path: str, event: str, due: int) -> Timer:
    due_ns = due * 1000 - nanoseconds(context.epoch)
    return Timer(event, due_ns, max(due_ns - nanoseconds(context.at), 0), event, None, path, "at")
