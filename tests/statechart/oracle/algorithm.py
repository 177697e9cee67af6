"""W3C SCXML 1.0, Appendix D ("Algorithm for SCXML Interpretation"), procedure by procedure, with its names.

No set is kept from one question to the next. Lumen adds that states have `after`, whose timers begin with the entry and
end with the exit; that the root is a state, with whose end the machine stops running; that what is done completes the
parallel states around it all the way up, where the pseudo-code goes up once; that a region of a parallel state may be
final; and that after `exitInterpreter` the configuration still holds the last states of the machine.
"""

from collections.abc import Callable
from typing import Any

from lumen.errors import ExpressionError
from lumen.language.events import Event
from lumen.language.machines import MachineDefinition, State, StateKind, Transition
from tests.statechart.oracle.content import LIMIT, RestlessError, Waiting, World
from tests.statechart.oracle.sets import Sets
from tests.statechart.oracle.tree import SCXML, is_atomic

Wanted = Callable[[Transition], bool]


class Oracle(Sets):
    """A running machine; `exited`, `entered` and `taken` describe the last macrostep."""

    def __init__(self, machine: MachineDefinition) -> None:
        super().__init__(World(machine, dict(machine.context)))
        self.begin_macrostep()
        self.running, self.output = True, None
        first = self.in_document_order(self.add_descendants(machine.root, []))
        self.turns += 1
        self.enter(first)
        self.settle()

    def begin_macrostep(self) -> None:
        self.exited: list[str] = []
        self.entered: list[str] = []
        self.taken: list[Transition] = []
        self.turns = 0
        self.world.raised, self.world.commands, self.world.failed = [], [], []

    def happen(self, event: Event) -> None:
        """Perform a macrostep with an event from outside."""
        self.external(event, lambda t: t.delay is None and matches(t, event.name))

    def tick(self) -> None:
        """Perform a macrostep with the timer that ends next; of those that end together, the one set first."""
        timer = min(self.world.timers, key=lambda t: t.due)
        self.world.timers = [t for t in self.world.timers if t is not timer]
        event = Event(timer.event, timer.data, timer.due, timer.id)
        if timer.state is None:
            self.happen(event)
        else:
            self.external(event, lambda t: t.delay is not None and t.event == timer.event)

    def external(self, event: Event, wanted: Wanted) -> None:
        self.begin_macrostep()
        self.world.at = max(self.world.at, event.at)
        if not self.running:
            return
        self.world.event = event
        self.microstep(self.select(wanted))
        self.settle()

    def settle(self) -> None:
        """`mainEventLoop`, from the first eventless transitions to the end of the macrostep."""
        while self.running:
            enabled = self.select(lambda t: not t.event)
            if not enabled:
                if not self.world.internal:
                    return
                event = self.world.event = self.world.internal.pop(0)
                self.count()
                enabled = self.select(lambda t, name=event.name: t.delay is None and matches(t, name))  # type: ignore[misc]
            self.microstep(enabled)
        self.exit_interpreter()

    def exit_interpreter(self) -> None:
        world, ended = self.world, list(self.world.configuration)
        for state in self.in_document_order(ended)[::-1]:
            world.execute(state.exit, state)
            world.configuration = [s for s in world.configuration if s is not state]
        world.configuration, world.timers, world.internal = ended, [], []

    def count(self) -> None:
        self.turns += 1
        if self.turns > LIMIT:
            raise RestlessError

    def select(self, wanted: Wanted) -> list[Transition]:
        """`selectTransitions` and `selectEventlessTransitions`."""
        enabled: list[Transition] = []
        for state in self.in_document_order(filter(is_atomic, self.world.configuration)):
            found = self.first(state, wanted)
            if found is not None and not any(found is other for other in enabled):
                enabled.append(found)
        return self.remove_conflicting(enabled)

    def first(self, state: State, wanted: Wanted) -> Transition | None:
        for source in [state, *self.proper_ancestors(state, None)]:
            for transition in source.transitions:
                if wanted(transition) and self.condition_match(transition):
                    return transition
        return None

    def condition_match(self, transition: Transition) -> bool:
        return transition.guard is None or self.world.holds(transition.guard, self.source(transition))

    def microstep(self, enabled: list[Transition]) -> None:
        if enabled:
            self.count()
            self.taken += enabled
            domains = self.domains(enabled)
            self.exit_states(enabled)
            for transition in enabled:
                self.world.execute(transition.actions, self.source(transition))
            self.enter(self.in_document_order(self.compute_entry_set(domains)))

    def exit_states(self, enabled: list[Transition]) -> None:
        world = self.world
        leaving = self.in_document_order(self.compute_exit_set(enabled))[::-1]
        for state in leaving:
            for history in self.histories(state):
                world.history[history.path] = [s for s in world.configuration if self.remembers(history, s)]
        for state in leaving:
            world.execute(state.exit, state)
            world.timers = [t for t in world.timers if t.state != state.path]
            world.configuration = [s for s in world.configuration if s is not state]
            self.exited += [state.name] if state.path else []

    def enter(self, states: list[State]) -> None:
        world = self.world
        for state in states:
            world.configuration.append(state)
            self.entered += [state.name] if state.path else []
            for event, delay in {t.event: t.delay for t in state.transitions if isinstance(t.delay, float)}.items():
                world.timers.append(Waiting(event, world.at + delay, None, state.path, event))
            world.execute(state.entry, state)
            if state.kind is StateKind.FINAL:
                self.done(state)

    def done(self, state: State) -> None:
        parent = self.parent(state)
        assert parent is not None  # no machine is a final state
        around = self.proper_ancestors(state, SCXML)
        if parent.kind is StateKind.COMPOUND:
            self.complete(parent, self.done_data(state))
            around = around[1:]
        for outer in around:
            if outer.kind is not StateKind.PARALLEL or not self.is_in_final(outer):
                break
            self.complete(outer, None)

    def complete(self, state: State, data: Any) -> None:
        if state is self.machine.root:
            self.running, self.output = False, data
        else:
            self.world.enqueue(Event(f"done.state.{state.name}", data, self.world.at))

    def done_data(self, state: State) -> Any:
        try:
            return self.world.value(state.output, state)
        except ExpressionError:
            self.world.fail((*state.where, "output"))
            return None

    def is_in_final(self, state: State) -> bool:
        children = self.children(state)
        if state.kind is StateKind.COMPOUND:
            return any(s.kind is StateKind.FINAL and s in self.world.configuration for s in children)
        if state.kind is StateKind.PARALLEL:
            return all(map(self.is_in_final, children))
        return state.kind is StateKind.FINAL and state in self.world.configuration


def matches(transition: Transition, name: str) -> bool:
    """Return whether the descriptor matches the event's name (3.12.1); `onDone` and `onError` need the whole name."""
    descriptor = transition.event
    if transition.exact:
        return descriptor == name
    tokens = descriptor.removesuffix(".*").split(".")
    return descriptor == "*" or (bool(descriptor) and name.split(".")[: len(tokens)] == tokens)
