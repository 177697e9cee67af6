"""Writes a macrostep as Python: what the algorithm finds out anew in each step is found out once, and the rest is left.

From an event in a configuration on, the algorithm is walked with what is `Certain`: which states are active, which
events are raised, which `do` begin. What only a step knows (the context, ids, times) is left to be computed; where that
decides, as at a guard, both ways are written. What this can't write ends in `return None`: there the whole algorithm
takes the step, from its beginning. So it does where anything raises.

The text names the user's states and commands by constants (`c0`, `c1`, …): what differs in them only has one text.
"""

from collections.abc import Callable, Mapping
from functools import partial
from typing import TypeAlias

from lumen.expressions.inlining import scope_needs
from lumen.language.actions import AskQuestion, If, Parallel, PlacedAction
from lumen.language.machines import State, StateKind
from lumen.statechart.chart import CompiledTransition, StateNode
from lumen.statechart.plans import Candidates, Configuration, Group, MicrostepPlan, MicrostepPlanner
from lumen.statechart.state_changes import StateChange
from lumen.statechart.step_actions import ActionText, Certain, Op
from lumen.statechart.step_code import WrittenStep
from lumen.statechart.step_text import MAX_LINES, NotPlainError, Sight
from lumen.statechart.values import Fork, Position, Within

Enabled: TypeAlias = tuple[CompiledTransition, ...]
DoPlace: TypeAlias = tuple[str, tuple[PlacedAction, ...], int]
"""Where a `do` stands in one of its blocks: the block's name, its actions, and which of them."""


class StepWriter(ActionText):
    """Writes one function; what is enabled at first is written apart by `apart`, where that is given."""

    def __init__(
        self, planner: MicrostepPlanner, start: Configuration, apart: Callable[[Enabled], WrittenStep] | None = None
    ) -> None:
        super().__init__(planner.chart, start)
        self.planner, self.apart, self.plain = planner, apart, False

    def heard(self, candidates: Candidates) -> WrittenStep | None:
        """What an event does that has these candidates; None where nothing of it is plain."""
        return self.written(self.select(candidates))

    def taken(self, enabled: Enabled) -> WrittenStep | None:
        """What these transitions do."""
        return self.written(partial(self.take, enabled))

    def elapsed(self, event: str) -> WrittenStep | None:
        """What the end of the timer of an `after` does."""
        self.sendid = "event[0]"
        self.line("timers = without_ended(timers, event)")
        return self.heard(self.start.timed(event))

    def resumed(self, node: StateNode, position: Within, branch: int | None) -> WrittenStep | None:
        """What is done after the command that the `do` of a state awaits there; in a `parallel`, in that branch."""
        place, awaiting = _after(_state(node).do, position)
        if not isinstance(awaiting, Fork):
            return self.written(partial(self.do, node, place))
        name, actions, number = place[-1]
        action = actions[number - 1].action
        if branch == 0 and isinstance(action, AskQuestion) and awaiting.branches[2:] == (None,):
            otherwise = (*place[:-1], (name, actions, number - 1), ("else", action.otherwise, 0))
            return self.written(partial(self.unanswered, node, otherwise))
        if branch is None or not isinstance(action, Parallel):
            return None
        if not any(other for i, other in enumerate(awaiting.branches) if i != branch):
            return self.written(partial(self.do, node, place))
        return self.written(partial(self.settle, node, branch))

    def unanswered(self, node: StateNode, otherwise: tuple[DoPlace, ...], known: Certain) -> None:
        """A question has got no answer: its time is not awaited any more, and what is to be done then begins."""
        self.line(f"timers = without_deadline(timers, doing[{self.constant(node.path)}])")
        known.first(partial(self.do, node, otherwise))

    def settle(self, node: StateNode, branch: int, known: Certain) -> None:
        path = self.constant(node.path)
        self.line(f"doing = placed(doing, {path}, settled(doing[{path}], {branch}))")

    def written(self, op: Op) -> WrittenStep | None:
        self.run(Certain(self.start, (op,)))
        return self.function() if self.plain else None

    def run(self, known: Certain) -> None:
        """Write it to the end: every way through it returns."""
        try:
            while not known.ended:
                self.go_on(known)
        except NotPlainError:
            self.end()

    def go_on(self, known: Certain) -> None:
        """What is next: the agenda, internal events, then what begins (`complete`)."""
        if known.agenda:
            op, *rest = known.agenda
            known.agenda = tuple(rest)
            op(known)
        elif known.configuration.finished:
            raise NotPlainError
        elif known.configuration.eventless and not known.settled:
            known.settled = True
            known.first(self.select(known.configuration.eventless))
        elif known.queue:
            (known.event, name), *others = known.queue
            known.queue, known.settled = tuple(others), False
            known.first(self.select(known.configuration.candidates(name)))
        elif known.beginnings:
            begun = sorted(known.beginnings, key=lambda node: node.index)
            known.beginnings, known.settled = (), False
            known.first(*(partial(self.do, node, (("do", _state(node).do, 0),)) for node in begun))
        else:
            self.plain = True
            self.result(known)

    def select(self, candidates: Candidates) -> Op:
        """Return the operation that selects among the candidates of an event."""
        return partial(self.decide, tuple(candidates), candidates, (), {})

    def decide(
        self,
        groups: tuple[Group, ...],
        candidates: Candidates,
        enabled: tuple[CompiledTransition | None, ...],
        facts: Mapping[str, bool],
        known: Certain,
    ) -> None:
        """The first candidate of each atomic state whose guard holds (`selectTransitions`).

        `groups` are those of the `candidates` that are left. `facts` are the guards that were asked before, for
        another candidate, and have no other answer here.
        """
        if not groups:
            self.decide_late(candidates.later, 0, enabled, known)
            return
        group, *others = groups
        for transition in group:
            then = partial(self.decide, tuple(others), candidates, (*enabled, transition))
            guard = transition.definition.guard
            if transition.rows:
                self.either(self.row(transition, known, late=False), known, partial(then, facts))
                continue
            if guard is None or facts.get(guard.source):
                known.first(partial(then, facts))
                return
            if guard.source not in facts:
                sight = Sight(known.event, transition.source, known.configuration.known)
                condition = self.expression(guard.source, sight, guard=True)
                everywhere = scope_needs(guard.source).isdisjoint(("state", "In"))
                self.either(condition, known, partial(then, {**facts, guard.source: True} if everywhere else facts))
                facts = {**facts, guard.source: False} if everywhere else facts
        known.first(partial(self.decide, tuple(others), candidates, (*enabled, None), facts))

    def decide_late(
        self,
        passes: tuple[tuple[Group, ...], ...],
        number: int,
        enabled: tuple[CompiledTransition | None, ...],
        known: Certain,
    ) -> None:
        """The late rows of `hears`, of the states from that number on which have taken nothing."""
        if passes and number == len(enabled):
            passes, number = passes[1:], 0
        if not passes or (not number and any(taken and taken.rows for taken in enabled)):
            known.first(partial(self.take, tuple(dict.fromkeys(filter(None, enabled)))))
            return
        for transition in passes[0][number] if enabled[number] is None else ():
            taken = (*enabled[:number], transition, *enabled[number + 1 :])
            self.either(
                self.row(transition, known, late=True), known, partial(self.decide_late, passes, number + 1, taken)
            )
        known.first(partial(self.decide_late, passes, number + 1, enabled))

    def row(self, transition: CompiledTransition, known: Certain, *, late: bool) -> str:
        """Whether a row of `hears` is the one that is taken of its state; the rows of a state are asked once."""
        block, hears = transition.rows, transition.definition.hears
        assert block is not None
        assert hears is not None
        if (chosen := self.chosen.get((block, late, known.event))) is None:
            chosen = f"h{len(self.chosen)}"
            sight = Sight(known.event, transition.source, known.configuration.known)
            self.see(frozenset(("event", "state", "In", "scope")), sight)
            self.line(f"{chosen} = {self.constant(block.chosen_late if late else block.chosen)}(scope)")
            self.chosen[block, late, known.event] = chosen
        return f"{chosen} == {hears.number}"

    def take(self, enabled: Enabled, known: Certain) -> None:
        """One microstep, with these transitions."""
        if not enabled:
            return
        if self.apart:
            self.line(f"return {self.constant(self.apart(enabled))}(snapshot, event)")
            self.plain = known.ended = True
            return
        if len(known.transitions) > MAX_LINES:  # of a machine that never comes to rest
            raise NotPlainError
        known.settled = False
        plan = self.planner.plan(known.configuration, enabled, {})
        if self.recalls(plan):
            raise NotPlainError
        if plan.history:
            self.line(f"history = {{**history, **{self.constant(plan.history)}}}")
        known.exited += plan.exited
        known.entered += plan.entered
        known.transitions += plan.transitions
        known.first(
            *(partial(self.exit, change) for change in plan.exits),
            *(partial(self.block, t.definition.actions, t.source, plan.between) for t in plan.taken),
            *(partial(self.enter, change) for change in plan.entries),
            partial(self.arrive, plan.target),
        )

    def recalls(self, plan: MicrostepPlan) -> bool:
        """Whether the states that are entered may depend on what history states remember."""
        targets = [target for transition in plan.taken for target in transition.targets]
        inside = [node for name in plan.entered for node in self.chart.by_name[name].initial]
        return any(node.kind is StateKind.HISTORY for node in (*targets, *inside))

    def arrive(self, target: Configuration, known: Certain) -> None:
        known.configuration = target

    def exit(self, change: StateChange, known: Certain) -> None:
        """`exitStates`, of one state: the actions, then its `do` and timers end."""
        node = change.node
        if node.invokes or node.schedules or node.computed:
            raise NotPlainError
        known.beginnings = tuple(other for other in known.beginnings if other is not node)
        known.first(partial(self.block, _state(node).exit, node, change.active), partial(self.stop, node))

    def stop(self, node: StateNode, known: Certain) -> None:
        path = self.constant(node.path)
        if node.do:
            left = f"leave({self.constant(node)}, at, timers, commands, doing, halted)"
            self.line(f"if {path} in doing: timers, commands, doing, halted = {left}")
            known.commanded = True
        if node.afters:
            self.line(f"timers = tuple([t for t in timers if t[6] != 'after' or t[5] != {path}]) if timers else ()")

    def enter(self, change: StateChange, known: Certain) -> None:
        """`enterStates`, of one state: timers begin, then the actions, and what it has to `do` after the macrostep."""
        node = change.node
        if node.invokes or node.schedules or node.computed or any(not parent.path for parent in change.done):
            raise NotPlainError
        for event, delay in node.afters:
            name = self.constant(event)
            self.timer(name, delay, name, "None", self.constant(node.path), "after")
        known.first(
            partial(self.block, _state(node).entry, node, change.active),
            partial(self.entered, node),
            *(partial(self.ended, node, parent) for parent in change.done),
        )

    def entered(self, node: StateNode, known: Certain) -> None:
        if node.do:
            path = self.constant(node.path)
            self.line(f"halted = without(halted, {path}) if {path} in halted else halted")
            known.beginnings += (node,)

    def ended(self, node: StateNode, parent: StateNode, known: Certain) -> None:
        """`done.state.*`, without the data of an output."""
        if node.output is not None and parent is node.parent and parent.kind is StateKind.COMPOUND:
            raise NotPlainError
        self.raises(f"done.state.{parent.name}", "None", known)

    def do(self, node: StateNode, place: tuple[DoPlace, ...], known: Certain) -> None:
        """The `do` of a state from there on (`Advance.block`); the outermost block comes first."""
        *around, (name, actions, number) = place
        path = self.constant(node.path)
        if number == len(actions):
            if not around:
                self.line(f"doing = placed(doing, {path}, None)")
                self.raises(f"done.do.{node.name}", "None", known)
                return
            *outer, (name, actions, number) = around
            known.first(partial(self.do, node, (*outer, (name, actions, number + 1))))
            return
        action = actions[number].action
        if isinstance(action, If):
            sight = Sight(known.event, node, known.configuration.known)
            condition = self.expression(action.guard.source, sight, guard=True)
            self.either(condition, known, partial(self.do, node, (*place, ("then", action.then, 0))))
            known.first(partial(self.do, node, (*place, ("else", action.otherwise, 0))))
        elif (position := self.begin(action, node, known)) == "None":
            known.first(partial(self.do, node, (*around, (name, actions, number + 1))))
        else:
            for block, _, index in reversed(place):
                position = f"new(Within, ({block!r}, {index}, {position}))"
            self.line(f"doing = placed(doing, {path}, {position})")


def _after(actions: tuple[PlacedAction, ...], position: Within) -> tuple[tuple[DoPlace, ...], Position]:
    """What comes after that position of these actions, and what is awaited there."""
    block, number, inner = position
    if not isinstance(inner, Within):
        return ((block, actions, number + 1),), inner
    action = actions[number].action
    assert isinstance(action, If | AskQuestion)  # which have blocks
    inside = action.then if isinstance(action, If) and inner.block == "then" else action.otherwise
    place, awaiting = _after(inside, inner)
    return ((block, actions, number), *place), awaiting


def _state(node: StateNode) -> State:
    assert node.state is not None  # only the document has none, and it is never left or entered
    return node.state
