"""The fast path for the most frequent steps: check guards, assign (in `entry` and `exit` too), be elsewhere.

A machine that only goes from state to state, and sets their timers, spends most of its time on making an
ExecutionContext and putting it away. Where nothing that is left or entered has anything else to do, say or raise, this
gives the same step without one: two or three times as fast. It decides nothing of its own: what it does for an event in
a configuration is read off the plans of `MicrostepPlanner`, once. Where anything is not plain, a failing expression
included, it gives up without a trace, and the whole algorithm takes the step from its beginning.
"""

from collections.abc import Callable
from typing import Any, NamedTuple, TypeVar

from lumen.interpreters.expressions import ExpressionError, Scope
from lumen.interpreters.expressions.scope import no_draw
from lumen.interpreters.statechart.blocks import compile_assignment
from lumen.interpreters.statechart.chart import CompiledGuard, CompiledTransition, StateNode
from lumen.interpreters.statechart.plans import Candidates, Configuration, MicrostepPlan, MicrostepPlanner, make_room
from lumen.interpreters.statechart.referenced_names import assigned_sources, referenced_names, sources_of
from lumen.interpreters.statechart.state_changes import StateChange
from lumen.interpreters.statechart.type_checks import TypeCheck
from lumen.interpreters.statechart.values import Snapshot, Step, Timer
from lumen.language.actions import Assign
from lumen.language.controllers import CONTROLLER_EVENT
from lumen.language.events import ARRIVED, LEFT, Event
from lumen.language.machines import State, Transition
from lumen.language.nanoseconds import nanoseconds
from lumen.language.shared import SHARED_EVENT

T = TypeVar("T")

_new = tuple.__new__  # a third of the price of Scope(…), Snapshot(…), Step(…)


class AfterTimers(NamedTuple):
    """The `after` timers that a step ends, by the paths of their states, and those it sets: event, delay [ns], path."""

    ended: frozenset[str]
    begun: tuple[tuple[str, int, str], ...]

    def at(self, now: float, timers: tuple[Timer, ...]) -> tuple[Timer, ...]:
        """The timers after the step, made at `now` [s]."""
        kept = [timer for timer in timers if timer.kind != "after" or timer.state not in self.ended]
        if not self.begun:
            return tuple(kept)
        at = nanoseconds(now)
        begun = [Timer(event, at + delay, delay, event, None, path, "after") for event, delay, path in self.begun]
        return (*kept, *begun)


class FastOutcome(NamedTuple):
    """What a step of some transitions comes to, if it is plain: the assignments, and the rest of the Step.

    `guard` is that of a single transition.
    """

    guard: CompiledGuard | None
    plain: bool
    assigns: tuple[tuple[str, Callable[[Scope], Any], TypeCheck | None], ...]
    target: frozenset[str]
    exited: tuple[str, ...]
    entered: tuple[str, ...]
    transitions: tuple[Transition, ...]
    timers: AfterTimers | None = None


class FastPath(NamedTuple):
    """What can come of an event in a configuration: an outcome, and where its guard is false what `otherwise` finds.

    It has the outcome's own fields, in one object: with a thousand states it counts how much memory a step visits.
    `uses_event` says whether any of the expressions refers to the event.
    """

    uses_event: bool
    guard: CompiledGuard | None
    plain: bool
    assigns: tuple[tuple[str, Callable[[Scope], Any], TypeCheck | None], ...]
    target: frozenset[str]
    exited: tuple[str, ...]
    entered: tuple[str, ...]
    transitions: tuple[Transition, ...]
    timers: AfterTimers | None
    otherwise: Callable[[Scope], FastOutcome]


class FastPaths:
    """The fast paths of a chart found out so far, by event and configuration; None where an event is not plain.

    `pool` holds what several outcomes have in common.
    """

    def __init__(self, planner: MicrostepPlanner) -> None:
        self.planner, self.definition = planner, planner.chart.definition
        self.paths: dict[str, dict[frozenset[str], FastPath | None]] = {}
        self.pool: dict[Any, Any] = {}

    def step(self, snapshot: Snapshot, event: Event) -> Step | None:
        """The step of this event, None where it is not plain."""
        (
            names, context, before, language, timers, doing, history, counters, generator, epoch, invoked, halted,
            place, zone, output,
        ) = snapshot  # fmt: skip
        name, data, at, sendid, _ = event
        if sendid or invoked:
            return None
        try:
            path = self.paths[name][names]
        except KeyError:
            path = self._find(names, name)
        if path is None:
            return None
        uses_event, guard, plain, assigns, target, exited, entered, transitions, after_timers, otherwise = path
        if not at >= before:  # earlier, or NaN
            at = before
        definition = self.definition
        event_data = {"name": name, "data": data} if uses_event else None
        scope = _new(
            Scope,
            (
                context, event_data, None, None, at, language, definition.phrases, definition.answers, epoch,
                zone, definition.lists, no_draw,
            ),
        )  # fmt: skip
        try:
            if guard is not None and (guard is _never or not guard(scope)):
                _, plain, assigns, target, exited, entered, transitions, after_timers = otherwise(scope)
            if not plain:
                return None
            for key, value, check in assigns:
                if scope[0] is not context:
                    scope = _new(Scope, (context, *scope[1:]))
                result = value(scope)
                if check and type(result) not in check.quick:
                    return None
                context = {**context, key: result}
        except ExpressionError:
            return None
        if after_timers:
            timers = after_timers.at(at, timers)
        after = (
            target, context, at, language, timers, doing, history, counters, generator, epoch, invoked, halted, place,
            zone, output,
        )  # fmt: skip
        return _new(Step, (event, exited, entered, (), _new(Snapshot, after), transitions, (), ()))

    def _find(self, names: frozenset[str], name: str) -> FastPath | None:
        """The path of an event in a configuration; kept, but for the robot's answers: each has a name of its own.

        What says where the robot is, or what a controller or another robot makes of the context, changes more than
        the states.
        """
        if ".command." in name or name in (ARRIVED, LEFT, SHARED_EVENT) or name.startswith(CONTROLLER_EVENT):
            return None
        make_room(self.paths)
        paths = self.paths.setdefault(name, {})
        make_room(paths)
        paths[names] = self._path(self.planner.configuration(names), name)
        return paths[names]

    def _path(self, start: Configuration, name: str) -> FastPath | None:
        candidates = start.candidates(name)
        used = referenced_names(source for group in candidates for t in group for source in sources_of(t.definition))
        if start.eventless or (candidates and self.planner.chart.has_history) or used & {"state", "In"}:
            return None
        uses_event = "event" in used
        if len(candidates) > 1:
            return FastPath(uses_event, *self._outcome(start, (), _never), self._chooser(start, candidates))
        outcomes = [self._outcome(start, t.alone, t.guard) for group in candidates for t in group]
        if outcomes and not any(outcome.plain for outcome in outcomes):
            return None
        first, *others = outcomes or [self._outcome(start, ())]
        return FastPath(uses_event, *first, self._first_enabled(start, others))

    def _chooser(self, start: Configuration, candidates: Candidates) -> Callable[[Scope], FastOutcome]:
        """Finds the outcome where several atomic states are active, each with its first candidate that is enabled."""
        outcomes: dict[tuple[CompiledTransition, ...], FastOutcome] = {}

        def choose(scope: Scope) -> FastOutcome:
            enabled: tuple[CompiledTransition, ...] = ()
            for group in candidates:
                for transition in group:
                    if transition.guard is None or transition.guard(scope):
                        enabled += transition.alone
                        break
            found = outcomes.get(enabled)
            if found is None:
                make_room(outcomes)
                found = outcomes[enabled] = self._outcome(start, enabled)
            return found

        return choose

    def _first_enabled(self, start: Configuration, outcomes: list[FastOutcome]) -> Callable[[Scope], FastOutcome]:
        """Finds the first of these outcomes whose guard holds, else that nothing is taken."""
        nothing: list[FastOutcome] = []

        def choose(scope: Scope) -> FastOutcome:
            for outcome in outcomes:
                if outcome.guard is None or outcome.guard(scope):
                    return outcome
            if not nothing:
                nothing.append(self._outcome(start, ()))
            return nothing[0]

        return choose

    def _outcome(
        self, start: Configuration, enabled: tuple[CompiledTransition, ...], guard: CompiledGuard | None = None
    ) -> FastOutcome:
        plan = self.planner.plan(start, tuple(dict.fromkeys(enabled)), {})
        busy = any(_is_busy(change) for change in (*plan.exits, *plan.entries))
        left = [step for change in plan.exits for step in _state(change.node).exit]
        entered = [step for change in plan.entries for step in _state(change.node).entry]
        actions = [step.action for step in (*left, *(s for t in plan.transitions for s in t.actions), *entered)]
        pairs = [pair for action in actions if isinstance(action, Assign) for pair in action.values.items()]
        used = referenced_names(assigned_sources((*left, *entered)))
        compiled = [compile_assignment(*pair) for pair in pairs]
        checks = self.planner.chart.checks
        return FastOutcome(
            guard,
            plain=not (busy or used & {"event", "state", "In"} or plan.target.eventless)
            and all(isinstance(action, Assign) for action in actions),
            assigns=self._shared(tuple((key, value, checks.get(key)) for key, value in compiled)),
            target=plan.target.names,
            exited=self._shared(plan.exited),
            entered=self._shared(plan.entered),
            transitions=plan.transitions,
            timers=_after_timers(plan),
        )

    def _shared(self, value: T) -> T:
        """An equal value that is there already, or this one."""
        make_room(self.pool)
        found: T = self.pool.setdefault(value, value)
        return found


def _never(_: Scope) -> bool:
    """Stands where no single transition decides."""
    return False


def _after_timers(plan: MicrostepPlan) -> AfterTimers | None:
    ended = frozenset(change.node.path for change in plan.exits if change.node.afters)
    begun = tuple((*after, change.node.path) for change in plan.entries for after in change.node.afters)
    return AfterTimers(ended, begun) if ended or begun else None


def _is_busy(change: StateChange) -> bool:
    """Whether more is begun or ended there than `after` timers."""
    node = change.node
    return bool(node.do or node.invokes or node.schedules or node.computed or change.done)


def _state(node: StateNode) -> State:
    assert node.state is not None  # only the document has none, and it is never left or entered
    return node.state
