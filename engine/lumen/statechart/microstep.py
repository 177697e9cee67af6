"""One microstep: selects enabled transitions, and exits and enters their states (SCXML Appendix D)."""

from typing import Any

from lumen.errors import LumenError
from lumen.expressions import ExpressionError
from lumen.language.diagnostics import NodePath
from lumen.language.events import Event
from lumen.language.machines import StateKind, Transition
from lumen.language.nanoseconds import nanoseconds
from lumen.statechart.action_context import ActionError
from lumen.statechart.blocks import CompiledBlock
from lumen.statechart.chart import CompiledGuard, CompiledTransition, StateNode
from lumen.statechart.computed_timers import begin_computed
from lumen.statechart.execution_context import Beginning, ExecutionContext
from lumen.statechart.plans import Candidates, Group, MicrostepPlan
from lumen.statechart.schedule_timers import begin_schedules
from lumen.statechart.values import Timer

MAX_SHOWN_TRANSITIONS = 6
"""The greatest number of transitions that the error about an endless loop names."""

MAX_MICROSTEPS = 1000
"""The greatest number of microsteps and internal events in one macrostep."""


def take_enabled(context: ExecutionContext, candidates: Candidates) -> bool:
    """Make one microstep with the enabled ones of these candidates; return False if no candidate is enabled."""
    enabled = select_transitions(context, candidates)
    if not enabled:
        return False
    microstep(context, context.machine.planner.plan(context.configuration, enabled, context.history))
    return True


def select_transitions(context: ExecutionContext, candidates: Candidates) -> tuple[CompiledTransition, ...]:
    """Return the first candidate of each atomic state whose guard is true (`selectTransitions`), then late ones."""
    if len(candidates) == 1 and not candidates.later:
        for transition in candidates[0]:
            if transition.guard is None or _holds(context, transition, transition.guard):
                return transition.alone
        return ()
    found = [_first(context, group) for group in candidates]
    if candidates.later and not _is_heard_inside(context):
        for groups in candidates.later:
            if any(taken and taken.rows for taken in found):
                break
            found = [taken or _first(context, group, late=True) for taken, group in zip(found, groups, strict=True)]
    return tuple(dict.fromkeys(transition for transition in found if transition))


def _first(context: ExecutionContext, group: Group, *, late: bool = False) -> CompiledTransition | None:
    for transition in group:
        guard = transition.late if late else transition.guard
        if guard is None or _holds(context, transition, guard):
            return transition
    return None


def _is_heard_inside(context: ExecutionContext) -> bool:
    """Return True if an invoked behaviour waits for the event too, because it may recognize the sentence."""
    event = context.unforwarded
    return event is not None and context.invocations.listens(context, event.name)


def microstep(context: ExecutionContext, plan: MicrostepPlan) -> None:
    """Exit states, run actions, enter states (`microstep`); exit everything if that ends the machine."""
    count_microstep(context)
    before = context.configuration
    taken, transitions, exits, between, entries, exited, entered, context.history, target = plan
    context.leave(transitions, exited, entered)
    for node, context.active, _ in exits:
        _exit(context, node)
    context.active = between
    for transition in taken:
        if transition.block:
            _execute(context, transition.block, transition.source)
    restored = _restored(context, taken) if context.activities.halted else frozenset[str]()
    for node, context.active, done in entries:
        _enter(context, node, done, restored)
    context.reach(target)
    if target.finished and not before.finished:
        _end(context)


def _end(context: ExecutionContext) -> None:
    """End the machine (`exitInterpreter`): run all exit actions, and drop its timers and pending events.

    The machine stays in its final configuration, so that its end remains visible.
    """
    for change in context.machine.planner.end(context.configuration).exits:
        context.active = change.active
        _exit(context, change.node)
    context.active = context.configuration.known
    context.timers, context.internal_queue, context.outbox = (), (), ()


def count_microstep(context: ExecutionContext) -> None:
    """Count one more microstep; raise LumenError with the loop if there are more than MAX_MICROSTEPS."""
    context.microsteps += 1
    if context.microsteps > MAX_MICROSTEPS:
        states = ", ".join(f"`{name}`" for name in sorted({*context.entered[-20:], *context.configuration.names}))
        raise LumenError(
            f"`{context.machine.chart.definition.id}` never comes to rest: after {MAX_MICROSTEPS:,} microsteps it still"
            f" goes through {states}; the loop is: {_round(context.transitions)}"
        )


def _round(transitions: tuple[Transition, ...]) -> str:
    """Return the last loop of transitions as text, each with its event and state."""
    last = next((i for i in range(2, len(transitions) + 1) if transitions[-i] is transitions[-1]), 1)
    taken = transitions[len(transitions) - min(last, MAX_SHOWN_TRANSITIONS + 1) + 1 :]
    ways = [f"`{t.event or 'always'}` of {f'`{t.source}`' if t.source else 'the behaviour'}" for t in taken]
    return ", then ".join(ways) or "events that no state waits for"


def _holds(context: ExecutionContext, transition: CompiledTransition, guard: CompiledGuard) -> bool:
    """Return a guard's value; a failing guard is False and raises error.execution (`conditionMatch`, SCXML 5.9.1)."""
    if transition.source is not context.node:
        context.evaluate_in(transition.source)
    try:
        return guard(context.cached_scope or context.scope())
    except ExpressionError as error:
        context.raise_error(str(error), transition.where)
        return False


def _exit(context: ExecutionContext, node: StateNode) -> None:
    """Exit one state (`exitStates`)."""
    if node.exit:
        _execute(context, node.exit, node)
    if context.beginnings:
        context.beginnings = tuple(beginning for beginning in context.beginnings if beginning.node is not node)
    if node.path in context.activities.positions:
        context.activities.halt(node, context.at)
        context.activities.cancel(context, node.path)
    if node.timed:
        context.timers = tuple(t for t in context.timers if t.kind not in ("after", "at") or t.state != node.path)
    if node.invokes:
        context.invocations.cancel(context, node)


def _restored(context: ExecutionContext, taken: tuple[CompiledTransition, ...]) -> frozenset[str]:
    """Return the paths of the states that history states among the targets restore, ancestors included."""
    targets = (t for transition in taken for t in transition.targets if t.kind is StateKind.HISTORY)
    nodes = (context.machine.chart.nodes[path] for t in targets for path in context.history.get(t.path, ()))
    return frozenset(node.path for found in nodes for node in (found, *found.ancestors))


def _enter(context: ExecutionContext, node: StateNode, done: tuple[StateNode, ...], restored: frozenset[str]) -> None:
    """Enter one state (`enterStates`).

    `done` are the ancestors that it finishes, the nearest first; `restored` are the paths that history states restore.
    """
    for event, delay in node.afters:
        due = nanoseconds(context.at) + delay
        context.timers = (*context.timers, Timer(event, due, delay, event, None, node.path, "after"))
    if node.schedules:
        begin_schedules(context, node)
    if node.entry:
        _execute(context, node.entry, node)
    if node.computed:
        begin_computed(context, node)
    if node.do or node.invokes:
        halted = context.activities.forget(node.path)
        halted = halted if node.path in restored else None
        context.beginnings += (Beginning(node, node.invokes, bool(node.do), halted),)
    for parent in done:
        data = _output(context, node) if parent is node.parent and parent.kind is StateKind.COMPOUND else None
        if parent.path:
            context.raise_event(Event(f"done.state.{parent.name}", data, context.at))
        else:
            context.output = data


def _execute(context: ExecutionContext, block: CompiledBlock, node: StateNode) -> None:
    """Execute the actions of a block; the first failure ends it (SCXML 4.9)."""
    if node is not context.node:
        context.evaluate_in(node)
    where: NodePath = ()
    try:
        for act, where in block:  # noqa: B007 - `where` is needed after a failure
            act(context)
    except (ExpressionError, ActionError) as error:
        context.raise_error(str(error), where)


def _output(context: ExecutionContext, node: StateNode) -> Any:
    """Return the output of a final state; None if there is none, or if computing it fails.

    A failure raises error.execution (SCXML 5.7.1).
    """
    if node.output is None:
        return None
    context.evaluate_in(node)
    try:
        return node.output(context.cached_scope or context.scope())
    except ExpressionError as error:
        assert node.state is not None  # only the document has no state
        context.raise_error(str(error), (*node.state.where, "output"))
        return None
