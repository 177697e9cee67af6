"""Generates a macrostep as Python code: decisions that are the same in every such step are made only once.

From an event in a configuration on, the writer follows the algorithm with everything that is `Certain`: the active
states, the raised events, the `do` that begin. Values that only a step has (the context, ids, times) are computed by
the text. If a decision depends on such a value, as in a guard, both branches are written. Unsupported parts end in
`return None`, and so does any exception: the full algorithm then computes the step from its beginning.

The text names the user's states and commands by constants (`c0`, `c1`, …), so that steps that differ only in them share
one text.
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
"""The position of a `do` in one of its blocks: the block's name, its actions, and the index of the action."""


class StepWriter(ActionText):
    """Writes one function; a branch that raises NotPlainError ends in `return None`.

    If `apart` is given, it provides a separate function for each set of transitions that is enabled first.
    """

    def __init__(
        self, planner: MicrostepPlanner, start: Configuration, apart: Callable[[Enabled], WrittenStep] | None = None
    ) -> None:
        super().__init__(planner.chart, start)
        self.planner, self.apart, self.plain = planner, apart, False

    def heard(self, candidates: Candidates) -> WrittenStep | None:
        """Return the function for an event with these candidates; None if none of its branches can be written."""
        return self.written(self.select(candidates))

    def taken(self, enabled: Enabled) -> WrittenStep | None:
        """Return the function that takes these transitions; None if none of its branches can be written."""
        return self.written(partial(self.take, enabled))

    def elapsed(self, event: str) -> WrittenStep | None:
        """Return the function that handles the end of an `after` timer; None if none of its branches can be written."""
        self.sendid = "event[0]"
        self.line("timers = without_ended(timers, event)")
        return self.heard(self.start.timed(event))

    def resumed(self, node: StateNode, position: Within, branch: int | None) -> WrittenStep | None:
        """Return the function for the end of an awaited command of a `do`; None if no branch of it can be written.

        `branch` is the command's index in a `parallel` or `ask`, else None.
        """
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
        """Write that a question stays unanswered: its deadline is removed and its `otherwise` block begins."""
        self.line(f"timers = without_deadline(timers, doing[{self.constant(node.path)}])")
        known.first(partial(self.do, node, otherwise))

    def settle(self, node: StateNode, branch: int, known: Certain) -> None:
        """Write the line that records the end of one branch of a `parallel`."""
        path = self.constant(node.path)
        self.line(f"doing = placed(doing, {path}, settled(doing[{path}], {branch}))")

    def written(self, op: Op) -> WrittenStep | None:
        """Write the operation and all that follows; return the function, None if no branch completes the step."""
        self.run(Certain(self.start, (op,)))
        return self.function() if self.plain else None

    def run(self, known: Certain) -> None:
        """Write the text to its end: every branch returns."""
        try:
            while not known.ended:
                self.go_on(known)
        except NotPlainError:
            self.end()

    def go_on(self, known: Certain) -> None:
        """Write the next operation: the agenda first, then internal events, then new `do` blocks (`complete`)."""
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
        """Write the choice of the first candidate of each atomic state whose guard is true (`selectTransitions`).

        `groups` are those of the `candidates` that are not decided yet. `facts` are the values of guards that were
        evaluated for another candidate and have the same value here.
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
        """Write the choice among late rows of `hears`, for the states from index `number` on that have not reacted."""
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
        """Return a condition that is true if this row of `hears` is chosen; the rows of a state are evaluated once."""
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
        """Write one microstep with these transitions."""
        if not enabled:
            return
        if self.apart:
            self.line(f"return {self.constant(self.apart(enabled))}(snapshot, event)")
            self.plain = known.ended = True
            return
        if len(known.transitions) > MAX_LINES:  # the machine never comes to rest
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
        """Return True if the entered states may depend on what history states remember."""
        targets = [target for transition in plan.taken for target in transition.targets]
        inside = [node for name in plan.entered for node in self.chart.by_name[name].initial]
        return any(node.kind is StateKind.HISTORY for node in (*targets, *inside))

    def arrive(self, target: Configuration, known: Certain) -> None:
        """Record the configuration after a microstep."""
        known.configuration = target

    def exit(self, change: StateChange, known: Certain) -> None:
        """Write the exit of one state (`exitStates`): its actions, then the end of its `do` and timers."""
        node = change.node
        if node.invokes or node.schedules or node.computed:
            raise NotPlainError
        known.beginnings = tuple(other for other in known.beginnings if other is not node)
        known.first(partial(self.block, _state(node).exit, node, change.active), partial(self.stop, node))

    def stop(self, node: StateNode, known: Certain) -> None:
        """Write the end of the `do` and the timers of a state."""
        path = self.constant(node.path)
        if node.do:
            left = f"leave({self.constant(node)}, at, timers, commands, doing, halted)"
            self.line(f"if {path} in doing: timers, commands, doing, halted = {left}")
            known.commanded = True
        if node.afters:
            self.line(f"timers = tuple([t for t in timers if t[6] != 'after' or t[5] != {path}]) if timers else ()")

    def enter(self, change: StateChange, known: Certain) -> None:
        """Write the entry of one state (`enterStates`): timers, then actions; its `do` begins after the macrostep."""
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
        """Record that the `do` of an entered state begins after the macrostep."""
        if node.do:
            path = self.constant(node.path)
            self.line(f"halted = without(halted, {path}) if {path} in halted else halted")
            known.beginnings += (node,)

    def ended(self, node: StateNode, parent: StateNode, known: Certain) -> None:
        """Write the event `done.state.*`; an output as its data is not supported."""
        if node.output is not None and parent is node.parent and parent.kind is StateKind.COMPOUND:
            raise NotPlainError
        self.raises(f"done.state.{parent.name}", "None", known)

    def do(self, node: StateNode, place: tuple[DoPlace, ...], known: Certain) -> None:
        """Write the `do` of a state from a position on (`Advance.block`); `place` lists the outermost block first."""
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
    """Return the position that follows `position` in these actions, and what `position` awaits."""
    block, number, inner = position
    if not isinstance(inner, Within):
        return ((block, actions, number + 1),), inner
    action = actions[number].action
    assert isinstance(action, If | AskQuestion)  # only these have blocks
    inside = action.then if isinstance(action, If) and inner.block == "then" else action.otherwise
    place, awaiting = _after(inside, inner)
    return ((block, actions, number), *place), awaiting


def _state(node: StateNode) -> State:
    assert node.state is not None  # only the document has no state, and it is never left or entered
    return node.state
