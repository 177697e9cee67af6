"""One macrostep while it is made: the only thing that changes, and it is gone when the step is there."""

from collections import deque
from collections.abc import Mapping
from typing import Any

from lumen.errors import LumenError
from lumen.interpreters.expressions import ExpressionError, Scope
from lumen.interpreters.statechart.blocks import ActionError, Block
from lumen.interpreters.statechart.chart import Chart, Node, Rule
from lumen.interpreters.statechart.doing import DeedError, awaited, begin_block, resume
from lumen.interpreters.statechart.plans import Configuration, Plan, Planner
from lumen.interpreters.statechart.types import type_name
from lumen.interpreters.statechart.values import Counters, Snapshot, Step, Timer, Within
from lumen.language.commands import BodyCommand, Cancel, Command, Start
from lumen.language.diagnostics import Path
from lumen.language.events import Event
from lumen.language.machines import Transition

LIMIT = 1000
"""How many microsteps, or internal events, a macrostep may take."""

Groups = tuple[tuple[Rule, ...], ...]


class Run:
    """A snapshot being moved on by one event.

    What most events leave empty is empty in the class, and made only where it is needed.
    """

    scope: Scope | None = None
    happened: Mapping[str, Any] | None = None
    commands: tuple[Command, ...] = ()
    queue: deque[Event] | tuple[()] = ()
    waiting: tuple[Node, ...] = ()
    exited: tuple[str, ...] = ()
    entered: tuple[str, ...] = ()
    transitions: tuple[Transition, ...] = ()
    raised: tuple[Event, ...] = ()
    failed: frozenset[Path] = frozenset()
    begun: tuple[str, ...] = ()
    turns = 0

    def __init__(self, chart: Chart, planner: Planner, before: Snapshot, event: Event | None, at: float) -> None:
        self.chart, self.planner = chart, planner
        self.trigger = self.event = event
        self.at = at
        (
            names, self.context, _, self.language, self.timers, self.doing, self.history, self.counters,
            self.generator, self.epoch,
        ) = before  # fmt: skip
        self.configuration: Configuration = planner.configuration(names)
        self.active = self.configuration.known
        self.here = chart.root

    def settle(self) -> Step:
        """Take eventless transitions and internal events until there are none, then begin what was entered to do."""
        while True:
            if self.configuration.eventless and self.take(self.configuration.eventless):
                continue
            if self.queue:
                self.turns += 1
                if self.turns > LIMIT:
                    self.give_up()
                self.event, self.happened, self.scope = self.queue.popleft(), None, None
                self.take(self.configuration.candidates(self.event.name))
            elif self.waiting:
                self.begin_doing()
            else:
                return self.step()

    def take(self, groups: Groups) -> bool:
        """One microstep with the transitions that are enabled among these candidates; False where none is."""
        enabled = self.enabled(groups)
        if not enabled:
            return False
        self.microstep(self.planner.plan(self.configuration, enabled, self.history))
        return True

    def enabled(self, groups: Groups) -> tuple[Rule, ...]:
        """The first candidate of each atomic state whose guard holds."""
        if len(groups) == 1:
            for rule in groups[0]:
                if rule.guard is None or self.holds(rule):
                    return rule.alone
            return ()
        found: list[Rule] = []
        for group in groups:
            for rule in group:
                if rule.guard is None or self.holds(rule):
                    found.append(rule)
                    break
        return tuple(dict.fromkeys(found))

    def holds(self, rule: Rule) -> bool:
        """Whether a guard is true; one that fails is false, and error.execution."""
        assert rule.guard is not None  # asked only of rules that have one
        if rule.source is not self.here:
            self.stand(rule.source)
        try:
            return rule.guard(self.scope or self.view())
        except ExpressionError as error:
            self.fail(str(error), rule.where)
            return False

    def microstep(self, plan: Plan) -> None:
        """Leave, act, enter (`microstep`)."""
        self.turns += 1
        if self.turns > LIMIT:
            self.give_up()
        rules, transitions, exits, between, entries, exited, entered, self.history, target = plan
        self.transitions += transitions
        self.exited += exited
        self.entered += entered
        for node, self.active, _ in exits:
            self.leave(node)
        self.active = between
        for rule in rules:
            if rule.block:
                self.perform(rule.block, rule.source)
        for node, self.active, done in entries:
            self.enter(node, done)
        self.configuration = target
        self.active = target.known

    def enter(self, node: Node, done: tuple[Node, ...]) -> None:
        for event, delay in node.afters:
            self.timers = (*self.timers, Timer(event, self.at + delay, delay, event, None, node.path, "after"))
        if node.entry:
            self.perform(node.entry, node)
        if node.do:
            self.waiting += (node,)
        for ended, name in enumerate(done):
            self.post(Event(f"done.state.{name.name}", None if ended else self.output(node), self.at))

    def leave(self, node: Node) -> None:
        if node.exit:
            self.perform(node.exit, node)
        if node in self.waiting:
            self.waiting = tuple(other for other in self.waiting if other is not node)
        if node.path in self.doing:
            self.abandon(node.path)
        if node.afters:
            self.timers = tuple(t for t in self.timers if t.kind != "after" or t.state != node.path)

    def output(self, node: Node) -> Any:
        """The data of a final state; none where it can't be had (SCXML 5.7.1)."""
        if node.output is None:
            return None
        self.stand(node)
        try:
            return node.output(self.scope or self.view())
        except ExpressionError as error:
            assert node.state is not None  # only the document has none
            self.fail(str(error), (*node.state.where, "output"))
            return None

    def perform(self, block: Block, node: Node) -> None:
        """Do the actions of a block; the first that fails ends it."""
        if node is not self.here:
            self.stand(node)
        where: Path = ()
        try:
            for act, where in block:  # noqa: B007 - `where` is where it failed
                act(self)
        except (ExpressionError, ActionError) as error:
            self.fail(str(error), where)

    # `do`

    def begin_doing(self) -> None:
        """Begin the `do` of every state entered and not left, in the order of entry."""
        waiting, self.waiting = sorted(self.waiting, key=lambda node: node.index), ()
        for node in waiting:
            self.stand(node)
            self.progress(node, None)

    def answered(self, path: str, id: str) -> None:
        """Go on with the `do` of that state, since what it awaited is over."""
        node = self.chart.nodes[path]
        self.stand(node)
        self.progress(node, id)

    def progress(self, node: Node, id: str | None) -> None:
        self.begun = ()
        try:
            position = begin_block(self, node.do) if id is None else resume(self, node.do, self.doing[node.path], id)
        except DeedError as error:
            self.fail(error.reason, error.where)
            self.collapse(node, id, error.reason)
            return
        self.place(node.path, position)
        if position is None:
            self.post(Event(f"done.do.{node.name}", None, self.at))

    def collapse(self, node: Node, id: str | None, reason: str) -> None:
        """End a `do` that failed: its other commands are cancelled, and its state hears why."""
        self.release([i for i in (*awaited(self.doing.get(node.path)), *self.begun) if i != id])
        self.place(node.path, None)
        self.post(Event(f"error.do.{node.name}", {"command": id, "reason": reason}, self.at))

    def abandon(self, path: str) -> None:
        """End a `do` whose state is left."""
        self.release(list(awaited(self.doing[path])))
        self.place(path, None)

    def place(self, path: str, position: Within | None) -> None:
        rest = {p: where for p, where in self.doing.items() if p != path}
        self.doing = {**rest, path: position} if position else rest

    def release(self, ids: list[str]) -> None:
        """Cancel what is awaited under these ids: a timer is taken back, a command told so."""
        pauses = {t.id for t in self.timers if t.kind == "wait" and t.id in ids}
        self.timers = tuple(t for t in self.timers if t.kind != "wait" or t.id not in pauses)
        for id in ids:
            if id not in pauses:
                self.emit(Cancel(id))

    # What actions ask for

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
            raise ActionError(f"`{key}` is {check} and can't become a {type_name(value)}")
        self.context = {**self.context, key: value}
        self.scope = None

    def draw(self, count: int) -> int:
        """One of `count` alternatives, from the generator (Numerical Recipes' linear congruence)."""
        if count == 1:
            return 0
        self.generator = (self.generator * 1664525 + 1013904223) % 2**32
        return (self.generator >> 16) % count

    # What expressions see

    def stand(self, node: Node) -> None:
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

    # Trouble

    def fail(self, reason: str, where: Path) -> None:
        """Raise error.execution; not again for the same place while that is what is being handled."""
        handling = self.event is not None and self.event.name == "error.execution"
        if not (handling and where in self.failed):
            self.failed |= {where}
            place = ".".join(map(str, where))
            self.post(Event("error.execution", {"reason": reason, "where": place}, self.at))

    def give_up(self) -> None:
        """Raises LumenError: there is no end of microsteps."""
        states = ", ".join(f"`{name}`" for name in sorted({*self.entered[-20:], *self.configuration.names}))
        raise LumenError(
            f"`{self.chart.machine.id}` never comes to rest: after {LIMIT:,} microsteps it still goes through"
            f" {states}; look at their `always` and `raise`"
        )

    def step(self) -> Step:
        snapshot = tuple.__new__(
            Snapshot,
            (
                self.configuration.names,
                self.context,
                self.at,
                self.language,
                self.timers,
                self.doing,
                self.history,
                self.counters,
                self.generator,
                self.epoch,
            ),
        )
        taken = (self.trigger, self.exited, self.entered, self.commands, snapshot, self.transitions, self.raised)
        return tuple.__new__(Step, taken)
