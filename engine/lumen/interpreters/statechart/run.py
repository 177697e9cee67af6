"""One macrostep while it is made: the only thing that changes, and it is gone when the step is there."""

from typing import Any

from lumen.errors import LumenError
from lumen.interpreters.expressions import ExpressionError
from lumen.interpreters.statechart.activities import ActivityRunner
from lumen.interpreters.statechart.chart import CompiledTransition, StateNode
from lumen.interpreters.statechart.plans import MicrostepPlan
from lumen.interpreters.statechart.values import Snapshot, Step, Timer
from lumen.language.events import Event

MAX_MICROSTEPS = 1000
"""How many microsteps, or internal events, a macrostep may take."""

CandidateGroups = tuple[tuple[CompiledTransition, ...], ...]


class MacrostepRunner(ActivityRunner):
    """The main loop of SCXML's Appendix D."""

    def macrostep(self) -> None:
        """Take eventless transitions and internal events until there are none."""
        while True:
            if self.configuration.eventless and self.take(self.configuration.eventless):
                continue
            if not self.queue:
                return
            self.turns += 1
            if self.turns > MAX_MICROSTEPS:
                self.give_up()
            self.event, self.happened, self.scope = self.queue.popleft(), None, None
            self.take(self.configuration.candidates(self.event.name))

    def take(self, groups: CandidateGroups) -> bool:
        """One microstep with the transitions that are enabled among these candidates; False where none is."""
        enabled = self.enabled(groups)
        if not enabled:
            return False
        self.microstep(self.planner.plan(self.configuration, enabled, self.history))
        return True

    def enabled(self, groups: CandidateGroups) -> tuple[CompiledTransition, ...]:
        """The first candidate of each atomic state whose guard holds."""
        if len(groups) == 1:
            for rule in groups[0]:
                if rule.guard is None or self.holds(rule):
                    return rule.alone
            return ()
        found: list[CompiledTransition] = []
        for group in groups:
            for rule in group:
                if rule.guard is None or self.holds(rule):
                    found.append(rule)
                    break
        return tuple(dict.fromkeys(found))

    def holds(self, rule: CompiledTransition) -> bool:
        """Whether a guard is true; one that fails is false, and error.execution."""
        assert rule.guard is not None  # asked only of rules that have one
        if rule.source is not self.here:
            self.stand(rule.source)
        try:
            return rule.guard(self.scope or self.view())
        except ExpressionError as error:
            self.fail(str(error), rule.where)
            return False

    def microstep(self, plan: MicrostepPlan) -> None:
        """Leave, act, enter (`microstep`)."""
        self.turns += 1
        if self.turns > MAX_MICROSTEPS:
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

    def enter(self, node: StateNode, done: tuple[StateNode, ...]) -> None:
        for event, delay in node.afters:
            self.timers = (*self.timers, Timer(event, self.at + delay, delay, event, None, node.path, "after"))
        if node.entry:
            self.perform(node.entry, node)
        if node.do or node.invokes:
            self.waiting += (node,)
        for ended, name in enumerate(done):
            self.post(Event(f"done.state.{name.name}", None if ended else self.output(node), self.at))

    def leave(self, node: StateNode) -> None:
        if node.exit:
            self.perform(node.exit, node)
        if node in self.waiting:
            self.waiting = tuple(other for other in self.waiting if other is not node)
        if node.path in self.doing:
            self.abandon(node.path)
        if node.afters:
            self.timers = tuple(t for t in self.timers if t.kind != "after" or t.state != node.path)

    def output(self, node: StateNode) -> Any:
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

    def give_up(self) -> None:
        """Raises LumenError: there is no end of microsteps."""
        states = ", ".join(f"`{name}`" for name in sorted({*self.entered[-20:], *self.configuration.names}))
        raise LumenError(
            f"`{self.chart.machine.id}` never comes to rest: after {MAX_MICROSTEPS:,} microsteps it still goes through"
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
                self.invoked,
            ),
        )
        return tuple.__new__(
            Step,
            (
                self.trigger,
                self.exited,
                self.entered,
                self.commands,
                snapshot,
                self.transitions,
                self.raised,
                self.steps,
            ),
        )
