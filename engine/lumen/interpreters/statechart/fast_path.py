"""The shortest way through the most frequent steps: check guards, assign (in `entry` and `exit` too), be elsewhere.

A machine that only goes from state to state, and sets their timers, spends most of its time on making the workbench of
a `Run` and putting it away. Where nothing on the way has anything to do, say or raise, this gives the same step without
one: two or three times as fast. It decides nothing of its own: what it does for an event in a configuration is read off
the plans of `Planner`, once. Where anything is not plain, a failing expression included, it gives up without a trace,
and `Run` takes the step from its beginning.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Any, NamedTuple, TypeVar

from lumen.interpreters.expressions import ExpressionError, Scope, parse_expression
from lumen.interpreters.expressions.tree import FunctionCall, Identifier, walk
from lumen.interpreters.statechart.blocks import compile_value
from lumen.interpreters.statechart.chart import CompiledGuard, CompiledTransition, StateNode
from lumen.interpreters.statechart.plans import Configuration, MicrostepPlan, MicrostepPlanner, bound
from lumen.interpreters.statechart.types import TypeCheck
from lumen.interpreters.statechart.values import Snapshot, Step, Timer
from lumen.language.actions import Assign, ComputedValue, Expression, PlacedAction
from lumen.language.events import Event
from lumen.language.machines import State, Transition

T = TypeVar("T")

_new = tuple.__new__  # a third of the price of Scope(…), Snapshot(…), Step(…)


CandidateGroups = tuple[tuple[CompiledTransition, ...], ...]


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
    clocks: "AfterTimers | None" = None


class AfterTimers(NamedTuple):
    """The `after` timers that a move ends, by the paths of their states, and those that it sets: event, delay, path."""

    ended: frozenset[str]
    begun: tuple[tuple[str, float, str], ...]

    def at(self, now: float, timers: tuple[Timer, ...]) -> tuple[Timer, ...]:
        """The timers after the move, made at `now` [s]."""
        kept = [timer for timer in timers if timer.kind != "after" or timer.state not in self.ended]
        begun = [Timer(event, now + delay, delay, event, None, path, "after") for event, delay, path in self.begun]
        return (*kept, *begun)


class FastPath(NamedTuple):
    """What can come of an event in a configuration: a move, and where its guard does not hold what `otherwise` finds.

    It is the move's own fields, in one object: with a thousand states it counts how much memory a step visits. `hears`
    says whether any of the expressions asks for the event.
    """

    hears: bool
    guard: CompiledGuard | None
    plain: bool
    assigns: tuple[tuple[str, Callable[[Scope], Any], TypeCheck | None], ...]
    target: frozenset[str]
    exited: tuple[str, ...]
    entered: tuple[str, ...]
    transitions: tuple[Transition, ...]
    clocks: AfterTimers | None
    otherwise: Callable[[Scope], FastOutcome]


class FastPaths:
    """The ways of a chart found out so far, by event and configuration; None where an event is not plain.

    `pool` holds what several moves have in common.
    """

    def __init__(self, planner: MicrostepPlanner) -> None:
        self.planner, self.machine = planner, planner.chart.machine
        self.ways: dict[str, dict[frozenset[str], FastPath | None]] = {}
        self.pool: dict[Any, Any] = {}

    def step(self, snapshot: Snapshot, event: Event) -> Step | None:
        """The step of this event, None where it is not plain."""
        names, context, before, language, timers, doing, history, counters, generator, epoch, invoked = snapshot
        name, data, at, sendid = event
        if sendid or invoked:
            return None
        try:
            way = self.ways[name][names]
        except KeyError:
            way = self.find(names, name)
        if way is None:
            return None
        hears, guard, plain, assigns, target, exited, entered, transitions, clocks, otherwise = way
        if not at >= before:  # earlier, or NaN
            at = before
        machine = self.machine
        heard = {"name": name, "data": data} if hears else None
        scope = _new(Scope, (context, heard, None, None, at, language, machine.phrases, machine.answers, epoch))
        try:
            if guard is not None and (guard is _never or not guard(scope)):
                _, plain, assigns, target, exited, entered, transitions, clocks = otherwise(scope)
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
        if clocks:
            timers = clocks.at(at, timers)
        after = (target, context, at, language, timers, doing, history, counters, generator, epoch, invoked)
        return _new(Step, (event, exited, entered, (), _new(Snapshot, after), transitions, (), ()))

    def find(self, names: frozenset[str], name: str) -> FastPath | None:
        """The way of an event in a configuration; kept, but for the robot's answers: each has a name of its own."""
        if ".command." in name:
            return None
        bound(self.ways)
        ways = self.ways.setdefault(name, {})
        bound(ways)
        ways[names] = self.way(self.planner.configuration(names), name)
        return ways[names]

    def way(self, start: Configuration, name: str) -> FastPath | None:
        groups = start.candidates(name)
        asked = _asked(source for group in groups for rule in group for source in _sources(rule.transition))
        if start.eventless or self.planner.chart.has_history or asked & {"state", "In"}:
            return None
        hears = "event" in asked
        if len(groups) > 1:
            return FastPath(hears, *self.move(start, (), _never), self.together(start, groups))
        rules = groups[0] if groups else ()
        rows = [self.move(start, rule.alone, rule.guard) for rule in rules]
        if rows and not any(move.plain for move in rows):
            return None
        first, *others = [*rows, self.move(start, ())]
        return FastPath(hears, *first, _first(others))

    def together(self, start: Configuration, groups: CandidateGroups) -> Callable[[Scope], FastOutcome]:
        """Finds the move where several atomic states are active, each with its first candidate that is enabled."""
        moves: dict[tuple[CompiledTransition, ...], FastOutcome] = {}

        def choose(scope: Scope) -> FastOutcome:
            enabled: tuple[CompiledTransition, ...] = ()
            for group in groups:
                for rule in group:
                    if rule.guard is None or rule.guard(scope):
                        enabled += rule.alone
                        break
            found = moves.get(enabled)
            if found is None:
                bound(moves)
                found = moves[enabled] = self.move(start, enabled)
            return found

        return choose

    def move(
        self, start: Configuration, enabled: tuple[CompiledTransition, ...], guard: CompiledGuard | None = None
    ) -> FastOutcome:
        plan = self.planner.plan(start, tuple(dict.fromkeys(enabled)), {})
        around = [stop for stop in (*plan.exits, *plan.entries) if stop.node.do or stop.node.invokes or stop.done]
        left = [step for stop in plan.exits for step in _of(stop.node).exit]
        entered = [step for stop in plan.entries for step in _of(stop.node).entry]
        actions = [step.action for step in (*left, *(s for r in plan.rules for s in r.transition.actions), *entered)]
        pairs = [pair for action in actions if isinstance(action, Assign) for pair in action.values.items()]
        asked = _asked(source for step in (*left, *entered) for source in _assigned(step))
        checks = self.planner.chart.checks
        return FastOutcome(
            guard,
            plain=not (around or asked & {"event", "state", "In"} or plan.target.eventless)
            and all(isinstance(action, Assign) for action in actions),
            assigns=self.shared(tuple((key, compile_value(value), checks.get(key)) for key, value in pairs)),
            target=plan.target.names,
            exited=self.shared(plan.exited),
            entered=self.shared(plan.entered),
            transitions=plan.transitions,
            clocks=_clocks(plan),
        )

    def shared(self, value: T) -> T:
        """An equal value that is there already, or this one."""
        bound(self.pool)
        found: T = self.pool.setdefault(value, value)
        return found


def _never(_: Scope) -> bool:
    """Stands where no single transition decides."""
    return False


def _first(moves: list[FastOutcome]) -> Callable[[Scope], FastOutcome]:
    """Finds the first of these moves whose guard holds; the last one has none."""
    return lambda scope: next(move for move in moves if move.guard is None or move.guard(scope))


def _clocks(plan: MicrostepPlan) -> AfterTimers | None:
    ended = frozenset(stop.node.path for stop in plan.exits if stop.node.afters)
    begun = tuple((*after, stop.node.path) for stop in plan.entries for after in stop.node.afters)
    return AfterTimers(ended, begun) if ended or begun else None


def _of(node: StateNode) -> State:
    assert node.state is not None  # only the document has none, and it is never on the way
    return node.state


def _asked(sources: Iterable[str]) -> set[str]:
    """What these expressions ask for: `context`, `event`, `state`, `In`."""
    nodes = [node for source in set(sources) for node, _ in walk(parse_expression(source))]
    asks = any(isinstance(node, FunctionCall) and node.function == "In" for node in nodes)
    return {node.name for node in nodes if isinstance(node, Identifier)} | ({"In"} if asks else set())


def _sources(transition: Transition) -> Iterator[str]:
    """The expressions of its guard, and of what it assigns."""
    if transition.guard:
        yield transition.guard.source
    for step in transition.actions:
        yield from _assigned(step)


def _assigned(step: PlacedAction) -> Iterator[str]:
    if isinstance(step.action, Assign):
        yield from _in(tuple(step.action.values.values()))


def _in(value: ComputedValue) -> Iterator[str]:
    match value:
        case Expression(source):
            yield source
        case tuple():
            for item in value:
                yield from _in(item)
        case Mapping():
            for item in value.values():
                yield from _in(item)
