"""Behaviours that run inside another one: started and ended with the state that invokes them, and sent events."""

from collections import deque
from collections.abc import Mapping
from copy import deepcopy
from typing import Any

from lumen.errors import LumenError, UsageError
from lumen.expressions import ExpressionError
from lumen.language.commands import Tell
from lumen.language.events import Event
from lumen.statechart.chart import CompiledInvoke, StateNode
from lumen.statechart.command_ids import outer_command
from lumen.statechart.compiled_machine import CompiledMachine
from lumen.statechart.execution_context import ExecutionContext, place_after
from lumen.statechart.external_events import process
from lumen.statechart.macrostep import enter_machine, exit_machine
from lumen.statechart.microstep import MAX_MICROSTEPS
from lumen.statechart.type_checks import checked
from lumen.statechart.values import Invoked, Snapshot, Step

INVOKED_MICROSTEP_SHARE = 0.9
"""Share of the remaining microsteps that an invoked behaviour may use; the rest is for the reaction to it."""


def open_context(machine: CompiledMachine, snapshot: Snapshot, event: Event | None, at: float) -> ExecutionContext:
    """Return the context of a macrostep at `at` [s]; raise KeyError with the name of a state that the machine lacks."""
    return ExecutionContext.of(machine, snapshot, event, at, Invocations(snapshot.invoked))


class Invocations:
    """The behaviours invoked in a machine, each of which makes its own macrosteps (SCXML 6.4)."""

    __slots__ = ("children", "steps")

    def __init__(self, children: Mapping[str, Invoked]) -> None:
        self.children = children
        self.steps: tuple[tuple[str, Step], ...] = ()

    def begin(self, context: ExecutionContext, node: StateNode, invoke: CompiledInvoke) -> None:
        """Start a behaviour with the input of the state; raise `error.invoke.*` if the input fails or does not fit."""
        context.evaluate_in(node)
        id, chart = invoke.id, context.machine.invoked[invoke.behavior].chart
        try:
            given = checked(chart.definition.id, chart.checks, invoke.input(context.cached_scope or context.scope()))
        except (ExpressionError, UsageError) as error:
            context.raise_error(str(error), (*invoke.where, "input"))
            _raise_failure(context, id, str(error))
            return
        before = Snapshot(frozenset(), {**deepcopy(dict(chart.definition.context)), **given})
        self.children = {**self.children, id: Invoked(node.path, before, context.counters.commands)}
        self.deliver(context, id, None)

    def cancel(self, context: ExecutionContext, node: StateNode) -> None:
        """End the behaviours that a left state has invoked, and drop their pending done and error events."""
        for id in [id for id, child in self.children.items() if child.state == node.path]:
            self.end(context, id)
        gone = {f"{kind}.invoke.{invoke.id}" for kind in ("done", "error") for invoke in node.invokes}
        context.internal_queue = deque(event for event in context.internal_queue if event.name not in gone)

    def forward(self, context: ExecutionContext, event: Event) -> None:
        """Deliver an event to all invoked behaviours, in the order in which they were started."""
        for id in tuple(self.children):
            self.deliver(context, id, event)

    def post(self, context: ExecutionContext) -> None:
        """Deliver the events sent to behaviours and robots.

        An event without a recipient raises error.communication (SCXML 6.2.5).
        """
        sent, context.outbox = context.outbox, ()
        for id, event in sent:
            if id in self.children:
                self.deliver(context, id, event)
            elif id in context.machine.robots:
                context.emit(Tell(id, event.name, event.data))
            else:
                context.returned(id, event)

    def listens(self, context: ExecutionContext, name: str) -> bool:
        """Return True if an invoked behaviour has a transition for an event of that name now; `*` does not count."""
        return _listen(context.machine, self.children, name)

    def end(self, context: ExecutionContext, id: str) -> None:
        """End the invoked behaviour of that id: it exits all its states."""
        child = self._open(context, id, None)
        if child.configuration.names and not child.configuration.finished:
            self._follow(context, id, exit_machine(child))
        self.children = {other: child for other, child in self.children.items() if other != id}

    def adopt(self, context: ExecutionContext, id: str, child: Invoked) -> None:
        """Replace an invoked behaviour by its migrated form, and end it if it has finished."""
        self.children = {**self.children, id: child}
        _take_back(context, child.snapshot)
        machine = invoked_machine(context.machine, child.state, id)
        if machine.planner.configuration(child.snapshot.configuration).finished:
            self._finish(context, id, child.snapshot.output)

    def deliver(self, context: ExecutionContext, id: str, event: Event | None) -> None:
        """Deliver an event to the behaviour of that id, or start it if the event is None; merge the step that follows.

        If the behaviour fails, it ends and `error.invoke.ID` is raised.
        """
        state, _, commands = self.children[id]
        child = self._open(context, id, event)
        share = int(INVOKED_MICROSTEP_SHARE * (MAX_MICROSTEPS - context.microsteps))
        before = child.microsteps = MAX_MICROSTEPS - share
        try:
            step = enter_machine(child) if event is None else process(child, event)
        except LumenError as error:
            context.microsteps += MAX_MICROSTEPS - before
            self.end(context, id)
            _raise_failure(context, id, str(error))
            return
        context.microsteps += child.microsteps - before
        self.children = {**self.children, id: Invoked(state, step.snapshot, commands)}
        self._follow(context, id, step)
        for sent in child.for_parent:
            context.raise_event(sent)
        if child.configuration.finished:
            self._finish(context, id, step.snapshot.output)

    def _finish(self, context: ExecutionContext, id: str, output: Any) -> None:
        """End a behaviour that has finished and raise `done.invoke.ID` with its output (SCXML 6.4.1)."""
        self.end(context, id)
        context.raise_event(Event(f"done.invoke.{id}", output, context.at))

    def _open(self, context: ExecutionContext, id: str, event: Event | None) -> ExecutionContext:
        """Return the context of the behaviour of that id, with the language, counters and generator of the host."""
        state, before, _ = self.children[id]
        lent = before._replace(
            language=context.language, counters=context.counters, generator=context.generator, epoch=context.epoch,
            timezone=context.timezone, place=place_after(context.place, event),
        )  # fmt: skip
        return context.within(id, invoked_machine(context.machine, state, id), lent, event, Invocations(lent.invoked))

    def _follow(self, context: ExecutionContext, id: str, step: Step) -> None:
        """Merge a step's commands, and the language, counters and generator after it, into the host."""
        self.steps += ((id, step),)
        context.commands += tuple(outer_command(command, id) for command in step.commands)
        _take_back(context, step.snapshot)


def invoked_machine(machine: CompiledMachine, state: str, id: str) -> CompiledMachine:
    """Return the machine that the state at that path invokes under that id."""
    return machine.invoked[machine.chart.definition.invoked_behavior(state, id)]


def _listen(machine: CompiledMachine, children: Mapping[str, Invoked], name: str) -> bool:
    for id, child in children.items():
        inner = invoked_machine(machine, child.state, id)
        candidates = inner.planner.configuration(child.snapshot.configuration).candidates(name)
        waiting = (t for t in candidates.all if t.definition.event != "*")
        if any(waiting) or _listen(inner, child.snapshot.invoked, name):
            return True
    return False


def _take_back(context: ExecutionContext, after: Snapshot) -> None:
    context.language, context.counters, context.generator = after.language, after.counters, after.generator
    context.cached_scope = None


def _raise_failure(context: ExecutionContext, id: str, reason: str) -> None:
    context.raise_event(Event(f"error.invoke.{id}", {"reason": reason}, context.at))
