"""Behaviours that run within another one: begun, told what happens, and ended with the state that invoked them."""

from abc import ABC, abstractmethod
from collections import deque
from collections.abc import Callable, Mapping
from typing import Any, Self

from lumen.errors import LumenError, UsageError
from lumen.interpreters.expressions import ExpressionError, Scope
from lumen.interpreters.statechart.answers import labelled
from lumen.interpreters.statechart.chart import StateNode
from lumen.interpreters.statechart.program import CompiledMachine
from lumen.interpreters.statechart.run import MAX_MICROSTEPS, MacrostepRunner
from lumen.interpreters.statechart.types import checked
from lumen.interpreters.statechart.values import Invoked, Snapshot, Step
from lumen.language.events import Event
from lumen.language.machines import Invoke

INVOKED_MICROSTEP_SHARE = 0.9
"""The part of the microsteps still allowed that an invoked behaviour may take: what is left serves to answer it."""


class InvocationRunner(MacrostepRunner, ABC):
    """A run that knows of the behaviours invoked in it, each of them a run of its own (SCXML 6.4).

    `news` is an event from the world that they have not heard yet.
    """

    news: Event | None = None

    @abstractmethod
    def hear(self, event: Event) -> Step:
        """Take an event, and all that follows from it."""

    def open(self) -> Step:
        """Enter the initial states."""
        self.microstep(self.planner.beginning())
        return self.settle()

    def close(self) -> Step:
        """Leave every state, for the run is over; nobody hears what that raises (`exitInterpreter`)."""
        self.microstep(self.planner.end(self.configuration))
        return self.step()

    def settle(self) -> Step:
        """Go on until there is nothing more to do now.

        The news come to those who run already and still do; then what was entered begins.
        """
        while True:
            self.macrostep()
            if self.news:
                self.pass_on(self.news)
            elif self.waiting:
                self.begin_waiting()
            else:
                return self.step()

    def pass_on(self, event: Event) -> None:
        self.news = None
        for id in tuple(self.invoked):
            self.tell(id, event)

    def begin(self, node: StateNode) -> None:
        """Invoke what the state invokes, then begin its `do`."""
        for invoke, given in node.invokes:
            self.introduce(node, invoke, given)
        super().begin(node)

    def introduce(self, node: StateNode, invoke: Invoke, given: Callable[[Scope], Any]) -> None:
        """Begin a behaviour with the input that the state gives it, or say why it can't begin."""
        self.stand(node)
        try:
            values = given(self.scope or self.view())
            self.invite(invoke, node, values)
        except (ExpressionError, UsageError) as error:
            self.fail(str(error), (*invoke.where, "input"))
            self.lose(invoke.id, str(error))

    def leave(self, node: StateNode) -> None:
        """Leave a state; what it invoked ends after its `exit`, and is heard of no more."""
        super().leave(node)
        if node.invokes:
            for id in [id for id, child in self.invoked.items() if child.state == node.path]:
                self.end(id)
            gone = {f"{kind}.invoke.{invoke.id}" for kind in ("done", "error") for invoke, _ in node.invokes}
            self.queue = deque(event for event in self.queue if event.name not in gone)

    def invite(self, invoke: Invoke, node: StateNode, values: Mapping[str, Any]) -> None:
        """Begin a behaviour with these values in its context; raises UsageError where they don't fit."""
        chart = self.program.invoked[invoke.behavior].chart
        before = Snapshot(frozenset(), {**chart.machine.context, **checked(chart.machine.id, chart.checks, values)})
        self.invoked = {**self.invoked, invoke.id: Invoked(node.path, before, self.counters.commands)}
        self.tell(invoke.id, None)

    def tell(self, id: str, event: Event | None) -> None:
        """Let an invoked behaviour hear an event, or begin (None), and follow what comes of it."""
        state, _, commands = self.invoked[id]
        child = self.child(id, event)
        before = child.turns = MAX_MICROSTEPS - int(INVOKED_MICROSTEP_SHARE * (MAX_MICROSTEPS - self.turns))
        try:
            step = child.open() if event is None else child.hear(event)
        except LumenError as error:
            self.turns += MAX_MICROSTEPS - before
            self.end(id)
            self.lose(id, str(error))
            return
        self.turns += child.turns - before
        self.invoked = {**self.invoked, id: Invoked(state, step.snapshot, commands)}
        self.follow(id, step)
        if child.configuration.finished:
            output = output_of(step, child.chart.root.name)
            self.end(id)
            self.post(Event(f"done.invoke.{id}", output, self.at))

    def end(self, id: str) -> None:
        """End an invoked behaviour: it leaves all its states."""
        if self.invoked[id].snapshot.configuration:
            self.follow(id, self.child(id, None).close())
        self.invoked = {other: child for other, child in self.invoked.items() if other != id}

    def lose(self, id: str, reason: str) -> None:
        self.post(Event(f"error.invoke.{id}", {"reason": reason}, self.at))

    def child(self, id: str, event: Event | None) -> Self:
        """The run of an invoked behaviour; language, counters and generator are lent to it."""
        state, before, _ = self.invoked[id]
        lent = before._replace(
            language=self.language, counters=self.counters, generator=self.generator, epoch=self.epoch
        )
        return type(self)(self.program_of(state, id), lent, event, self.at)

    def program_of(self, state: str, id: str) -> CompiledMachine:
        behavior = next(invoke.behavior for invoke, _ in self.chart.nodes[state].invokes if invoke.id == id)
        return self.program.invoked[behavior]

    def follow(self, id: str, step: Step) -> None:
        """Take over what a step of an invoked behaviour asks for, and what was lent to it."""
        self.steps += ((id, step),)
        self.commands += tuple(labelled(command, id) for command in step.commands)
        after = step.snapshot
        self.language, self.counters, self.generator = after.language, after.counters, after.generator
        self.scope = None


def output_of(step: Step, root: str) -> Any:
    """The output of the final state in which a machine came to its end."""
    return next((event.data for event in reversed(step.raised) if event.name == f"done.state.{root}"), None)
