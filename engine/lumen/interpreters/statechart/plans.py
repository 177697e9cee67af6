"""What a microstep does, worked out once for each configuration and set of transitions, and kept."""

from collections.abc import Callable, Container, Mapping, Sequence
from collections.abc import Set as AbstractSet
from typing import Any, NamedTuple

from lumen.interpreters.statechart.active_view import ActiveView
from lumen.interpreters.statechart.chart import Chart, CompiledTransition, StateNode
from lumen.interpreters.statechart.state_sets import History, StateSets, in_final
from lumen.language.machines import StateKind, Transition

MAX_CACHE_ENTRIES = 4096
"""How many entries a cache holds before it is emptied: charts with many regions have no end of configurations."""


class StateChange(NamedTuple):
    """One state on the way out or in, and what counts as active (`In`) while its actions run.

    `done` are the states whose end its entry brings about, the nearest first.
    """

    node: StateNode
    active: Container[str]
    done: tuple[StateNode, ...] = ()


class MicrostepPlan(NamedTuple):
    """A microstep: what is left, done and entered. States without anything to do are not among the stops."""

    rules: tuple[CompiledTransition, ...]
    transitions: tuple[Transition, ...]
    exits: tuple[StateChange, ...]
    between: frozenset[str]
    entries: tuple[StateChange, ...]
    exited: tuple[str, ...]
    entered: tuple[str, ...]
    remembered: Mapping[str, tuple[str, ...]]
    target: "Configuration"


class Configuration:
    """A set of active states, with the candidates of each event and the plans made from it so far."""

    def __init__(self, nodes: frozenset[StateNode]) -> None:
        self.nodes = nodes
        self.ordered = sorted(nodes, key=lambda node: node.index)
        self.names = frozenset(node.name for node in nodes if node.path)
        self.known = known(nodes)
        self.plans: dict[tuple[object, ...], MicrostepPlan] = {}
        self._leaves = [node for node in self.ordered if not any(child in nodes for child in node.children)]
        self._by_name: dict[str, tuple[tuple[CompiledTransition, ...], ...]] = {}
        self.eventless = self._select(lambda rule: not rule.transition.event)

    @property
    def finished(self) -> bool:
        """Whether the whole machine has come to its end."""
        return in_final(self.ordered[0], self.nodes)

    def candidates(self, name: str) -> tuple[tuple[CompiledTransition, ...], ...]:
        """For each active atomic state the transitions that an event of that name selects, the innermost first."""
        found = self._by_name.get(name)
        if found is None:
            bound(self._by_name)
            found = self._by_name[name] = self._select(lambda rule: rule.matches(name))
        return found

    def timed(self, event: str) -> tuple[tuple[CompiledTransition, ...], ...]:
        """The `after` transitions of that timer."""
        return self._select(lambda rule: rule.transition.delay is not None and rule.transition.event == event)

    def _select(self, wanted: Callable[[CompiledTransition], bool]) -> tuple[tuple[CompiledTransition, ...], ...]:
        groups = (
            tuple(rule for node in (leaf, *leaf.ancestors) for rule in node.rules if wanted(rule))
            for leaf in self._leaves
        )
        return tuple(group for group in groups if group)


class MicrostepPlanner:
    """Makes and keeps the configurations and plans of a chart."""

    def __init__(self, chart: Chart) -> None:
        self.chart = chart
        self._by_names: dict[frozenset[str], Configuration] = {}
        self.nothing = Configuration(frozenset())

    def configuration(self, names: frozenset[str]) -> Configuration:
        """The configuration of these names; raises KeyError with a name that the chart does not have."""
        found = self._by_names.get(names)
        if found is None:
            nodes = {self.chart.by_name[name] for name in names} | {self.chart.root}
            bound(self._by_names)
            found = self._by_names[names] = Configuration(frozenset(nodes))
        return found

    def beginning(self) -> MicrostepPlan:
        """The microstep that enters a machine."""
        return self._make(self.nothing, (), {}, set(), StateSets(self.chart, {}).beginning())

    def end(self, start: Configuration) -> MicrostepPlan:
        """The microstep that leaves every state (`exitInterpreter`)."""
        return self._make(start, (), {}, set(start.nodes), set())

    def passage(
        self, start: Configuration, left: set[StateNode], entered: set[StateNode], history: History
    ) -> MicrostepPlan:
        """The microstep that leaves and enters these states, though no transition says so."""
        return self._make(start, (), history, left, entered)

    def plan(self, start: Configuration, enabled: tuple[CompiledTransition, ...], history: History) -> MicrostepPlan:
        """The microstep that these enabled transitions make from there."""
        key = (enabled, *history.items()) if self.chart.has_history else enabled
        found = start.plans.get(key)
        if found is None:
            bound(start.plans)
            topology = StateSets(self.chart, history)
            rules = _without_conflicts(topology, enabled, start)
            left = topology.exit_set(rules, start.nodes)
            kept = {**history, **_remembered(start.nodes, left)}  # a history target finds what is left just now
            entered = StateSets(self.chart, kept, start.nodes - left).entry_set(topology.domains(rules))
            found = start.plans[key] = self._make(start, rules, kept, left, entered)
        return found

    def _make(
        self,
        start: Configuration,
        rules: tuple[CompiledTransition, ...],
        history: History,
        left: set[StateNode],
        entered: set[StateNode],
    ) -> MicrostepPlan:
        out = sorted(left, key=lambda node: -node.index)
        way_in = sorted(entered, key=lambda node: node.index)
        active = set(start.nodes)
        exits = _ways_out(out, active)
        between = known(active)
        entries = _ways_in(way_in, active)
        return MicrostepPlan(
            rules=rules,
            transitions=tuple(rule.transition for rule in rules),
            exits=exits,
            between=between,
            entries=entries,
            exited=tuple(node.name for node in out if node.path),
            entered=tuple(node.name for node in way_in if node.path),
            remembered={**history, **_remembered(start.nodes, left)},
            target=self.configuration(frozenset(node.name for node in active if node.path)),
        )


def known(nodes: AbstractSet[StateNode]) -> frozenset[str]:
    """Everything that `In()` says true to: paths and aliases."""
    return frozenset(name for node in nodes for name in (node.path, node.name) if name)


def _ways_out(way: Sequence[StateNode], active: set[StateNode]) -> tuple[StateChange, ...]:
    before, passed = known(active), _places(way)
    stops = [
        StateChange(node, ActiveView(before, passed, i, False)) for i, node in enumerate(way) if node.exit or node.busy
    ]
    active.difference_update(way)
    return tuple(stops)


def _ways_in(way: Sequence[StateNode], active: set[StateNode]) -> tuple[StateChange, ...]:
    before, passed = known(active), _places(way)
    stops = []
    for place, node in enumerate(way):
        active.add(node)
        done = _done(node, active)
        if node.entry or node.busy or done:
            stops.append(StateChange(node, ActiveView(before, passed, place, True), done))
    return tuple(stops)


def _places(way: Sequence[StateNode]) -> dict[str, int]:
    return {name: place for place, node in enumerate(way) for name in (node.path, node.name) if name}


def _done(node: StateNode, active: AbstractSet[StateNode]) -> tuple[StateNode, ...]:
    """The states whose end it is that `node` was entered: its parent, and a parallel state around that."""
    parent = node.parent
    if node.kind is not StateKind.FINAL or parent is None:
        return ()
    outer = parent.parent
    if outer and outer.kind is StateKind.PARALLEL and in_final(outer, active):
        return parent, outer
    return (parent,)


def _remembered(active: frozenset[StateNode], left: set[StateNode]) -> dict[str, tuple[str, ...]]:
    """What the history states of the states left have to remember (SCXML 3.10)."""
    found: dict[str, tuple[str, ...]] = {}
    for parent in left:
        for history in parent.histories:
            assert history.state is not None  # only the document has none
            deep = history.state.deep
            kept = [n for n in active if (_is_leaf(n) and n.lies_below(parent) if deep else n.parent is parent)]
            found[history.path] = tuple(n.path for n in sorted(kept, key=lambda n: n.index))
    return found


def _is_leaf(node: StateNode) -> bool:
    return node.kind in (StateKind.ATOMIC, StateKind.FINAL)


def _without_conflicts(
    topology: StateSets, enabled: Sequence[CompiledTransition], start: Configuration
) -> tuple[CompiledTransition, ...]:
    """The transitions that can be taken together (`removeConflictingTransitions`)."""
    kept: dict[CompiledTransition, set[StateNode]] = {}
    taken: set[StateNode] = set()
    for rule in enabled:
        left = topology.exit_set([rule], start.nodes)
        rivals = [] if taken.isdisjoint(left) else [other for other in kept if kept[other] & left]
        if all(rule.source.lies_below(other.source) for other in rivals):
            for other in rivals:
                del kept[other]
            kept[rule] = left
            taken |= left
    return tuple(kept)


def bound(cache: dict[Any, Any]) -> None:
    """Empty a cache that is full."""
    """Empty a cache that is full."""
    if len(cache) >= MAX_CACHE_ENTRIES:
        cache.clear()
