"""A snapshot while it is moved on: what actions ask for, and what expressions see."""

from collections import deque
from collections.abc import Container, Mapping
from typing import Any

from lumen.interpreters.expressions import ExpressionError, Scope
from lumen.interpreters.statechart.blocks import ActionError, CompiledBlock
from lumen.interpreters.statechart.chart import StateNode
from lumen.interpreters.statechart.plans import Configuration
from lumen.interpreters.statechart.program import CompiledMachine
from lumen.interpreters.statechart.values import Counters, Snapshot, Step, Timer
from lumen.language.commands import BodyCommand, Command, Start
from lumen.language.diagnostics import NodePath
from lumen.language.events import Event
from lumen.language.machines import Transition


class ExecutionContext:
    """A snapshot being moved on by one event, as actions and expressions see it.

    What most events leave empty is empty in the class, and made only where it is needed.
    """

    scope: Scope | None = None
    happened: Mapping[str, Any] | None = None
    commands: tuple[Command, ...] = ()
    queue: deque[Event] | tuple[()] = ()
    waiting: tuple[StateNode, ...] = ()
    exited: tuple[str, ...] = ()
    entered: tuple[str, ...] = ()
    transitions: tuple[Transition, ...] = ()
    raised: tuple[Event, ...] = ()
    failed: frozenset[NodePath] = frozenset()
    begun: tuple[str, ...] = ()
    steps: tuple[tuple[str, Step], ...] = ()
    turns = 0

    def __init__(self, program: CompiledMachine, before: Snapshot, event: Event | None, at: float) -> None:
        self.program = program
        self.chart, self.planner, *_ = program
        self.trigger = self.event = event
        self.at = at
        (
            names, self.context, _, self.language, self.timers, self.doing, self.history, self.counters,
            self.generator, self.epoch, self.invoked,
        ) = before  # fmt: skip
        self.configuration: Configuration = self.planner.configuration(names)
        self.active: Container[str] = self.configuration.known
        self.here = self.chart.root

    def perform(self, block: CompiledBlock, node: StateNode) -> None:
        """Do the actions of a block; the first that fails ends it."""
        if node is not self.here:
            self.stand(node)
        where: NodePath = ()
        try:
            for act, where in block:  # noqa: B007 - `where` is where it failed
                act(self)
        except (ExpressionError, ActionError) as error:
            self.fail(str(error), where)

    def start(self, command: BodyCommand, *, awaited: bool = False) -> str:
        """Start a command; its id."""
        commands, waited, timers = self.counters
        if awaited:
            id = f"d{waited + 1}"
            self.counters = Counters(commands, waited + 1, timers)
            self.begun += (id,)
        else:
            id = f"c{commands + 1}"
            self.counters = Counters(commands + 1, waited, timers)
        self.emit(Start(id, command))
        return id

    def emit(self, command: Command) -> None:
        """Something for the edge to perform."""
        self.commands = (*self.commands, command)

    def set_timer(self, id: str, delay: float, event: str, data: Any) -> None:
        """A `send`: due after `delay` [s], at the earliest in the next macrostep."""
        id = id or self.number("s")
        self.timers = (*self.timers, Timer(id, self.at + delay, delay, event, data))

    def set_wait(self, seconds: float) -> str:
        """A `wait` of the `do` that is being done; its id."""
        id = self.number("w")
        timer = Timer(id, self.at + seconds, seconds, f"wait.{id}", None, self.here.path, "wait")
        self.timers = (*self.timers, timer)
        self.begun += (id,)
        return id

    def number(self, letter: str) -> str:
        self.counters = self.counters._replace(timers=self.counters.timers + 1)
        return f"{letter}{self.counters.timers}"

    def cancel_send(self, id: str) -> None:
        self.timers = tuple(t for t in self.timers if t.kind != "send" or t.id != id)

    def post(self, event: Event) -> None:
        """An internal event."""
        if not self.queue:
            self.queue = deque()
        self.queue.append(event)
        self.raised += (event,)

    def store(self, key: str, value: Any) -> None:
        """Give a context key another value; raises ActionError where it is of another type."""
        check = self.chart.checks.get(key)
        if check and type(value) not in check.quick and not check.accepts(value):
            raise ActionError(f"`{key}` {check.refusal(value, 'become')}")
        self.context = {**self.context, key: value}
        self.scope = None

    def draw(self, count: int) -> int:
        """One of `count` alternatives, from the generator (Numerical Recipes' linear congruence)."""
        if count == 1:
            return 0
        self.generator = (self.generator * 1664525 + 1013904223) % 2**32
        return (self.generator >> 16) % count

    def stand(self, node: StateNode) -> None:
        """Let `state` in expressions be this one."""
        if node is not self.here:
            self.here, self.scope = node, None

    def is_active(self, state: str) -> bool:
        """`In()`: asks of this moment, so that a scope serves while states come and go."""
        return state in self.active

    def view(self) -> Scope:
        """What an expression sees now."""
        scope = self.scope
        if scope is None:
            event, machine = self.event, self.chart.machine
            if event is not None and self.happened is None:
                self.happened = {"name": event.name, "data": event.data}
            scope = self.scope = tuple.__new__(  # a third of the price of Scope(…)
                Scope,
                (
                    self.context,
                    self.happened,
                    self.here.view(self.language),
                    self.is_active,
                    self.at,
                    self.language,
                    machine.phrases,
                    machine.answers,
                    self.epoch,
                ),
            )
        return scope

    def fail(self, reason: str, where: NodePath) -> None:
        """Raise error.execution; not again for the same place while that is what is being handled."""
        handling = self.event is not None and self.event.name == "error.execution"
        if not (handling and where in self.failed):
            self.failed |= {where}
            place = ".".join(map(str, where))
            self.post(Event("error.execution", {"reason": reason, "where": place}, self.at))
