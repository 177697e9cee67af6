"""The effect of a microstep, computed once for each configuration and set of transitions, then cached."""

from collections.abc import Callable, Iterator
from collections.abc import Set as AbstractSet
from typing import Any, NamedTuple, TypeAlias

from lumen.language.machines import Transition
from lumen.statechart.chart import Chart, CompiledTransition, StateNode
from lumen.statechart.history import History, recorded
from lumen.statechart.state_changes import (
    StateChange,
    entries,
    entry_order,
    exit_order,
    exits,
    names_of,
)
from lumen.statechart.state_sets import StateSets, in_final

MAX_CACHE_ENTRIES = 4096
"""The number of entries at which a cache is emptied, because charts with many regions have very many configurations."""

Group: TypeAlias = tuple[CompiledTransition, ...]


class Candidates(tuple[Group, ...]):
    """The transitions that an event selects: a group for each active atomic state, the innermost first."""

    later: tuple[tuple[Group, ...], ...] = ()
    """Rows of `hears` of the same states, in two passes: rows whose phrase consists only of slots, then `else`. A pass
    is for states that have not reacted, unless some state has reacted with a row. Empty if there are no rows.
    """

    @property
    def all(self) -> Iterator[CompiledTransition]:
        """Yield every transition that may be taken."""
        yield from (t for groups in (self, *self.later) for group in groups for t in group)


NO_CANDIDATES = Candidates()


class MicrostepPlan(NamedTuple):
    """A microstep: the states to exit and enter, and the transitions to run."""

    taken: tuple[CompiledTransition, ...]
    """The transitions that the microstep takes, compiled."""
    transitions: tuple[Transition, ...]
    """The definitions of these transitions."""
    exits: tuple[StateChange, ...]
    """The states to exit, in exit order; idle states, which have nothing to execute, are omitted."""
    between: frozenset[str]
    """The names that are active while the actions of the transitions run."""
    entries: tuple[StateChange, ...]
    """The states to enter, in entry order, without idle states."""
    exited: tuple[str, ...]
    """The names of all states that the microstep exits, in exit order."""
    entered: tuple[str, ...]
    """The names of all states that the microstep enters, in entry order."""
    history: History
    """The memory of history states afterwards."""
    target: "Configuration"
    """The configuration afterwards."""


class Configuration:
    """A set of active states (SCXML 3.11), with caches of candidates by event and of plans that start from it."""

    def __init__(self, nodes: frozenset[StateNode]) -> None:
        self.nodes = nodes
        self.ordered = entry_order(nodes)
        self.finished = bool(nodes) and in_final(self.ordered[0], nodes)
        """Whether the configuration ends the machine; then it has no candidates."""
        self.names = frozenset(node.name for node in nodes if node.path)
        """The names that a Snapshot holds."""
        self.known = names_of(nodes)
        """The names for which `In` is true."""
        self.plans: dict[tuple[object, ...], MicrostepPlan] = {}
        inner = {node.parent for node in nodes}
        self.leaves = [node for node in self.ordered if node not in inner]
        """The active states without active children, in document order."""
        self._by_event: dict[str, Candidates] = {}
        self.eventless = self._select(lambda transition: not transition.definition.event)

    def candidates(self, name: str) -> Candidates:
        """Return the transitions that an event of that name selects."""
        found = self._by_event.get(name)
        if found is None:
            make_room(self._by_event)
            found = self._by_event[name] = self._select(lambda transition: transition.matches(name))
        return found

    def timed(self, event: str) -> Candidates:
        """Return the `after` or `at` transitions of that timer."""
        return self._select(lambda t: t.definition.timed and t.definition.event == event)

    def _select(self, wanted: Callable[[CompiledTransition], bool]) -> Candidates:
        if self.finished:
            return NO_CANDIDATES
        groups: list[Group] = []
        for leaf in self.leaves:
            found = [t for node in (leaf, *leaf.ancestors) for t in node.transitions if wanted(t)]
            if found:
                groups.append(tuple(found))
        if not any(t.rows for group in groups for t in group):
            return Candidates(groups)
        candidates = Candidates(tuple(t for t in group if not t.is_otherwise) for group in groups)
        candidates.later = (
            tuple(tuple(t for t in group if t.rows and not t.is_otherwise) for group in groups),
            tuple(tuple(t for t in group if t.is_otherwise) for group in groups),
        )
        return candidates


class MicrostepPlanner:
    """Makes and caches the configurations and plans of a chart."""

    def __init__(self, chart: Chart) -> None:
        self.chart = chart
        self._by_names: dict[frozenset[str], Configuration] = {}
        self._names: dict[tuple[str, ...], tuple[str, ...]] = {}
        self.nothing = Configuration(frozenset())

    def configuration(self, names: frozenset[str]) -> Configuration:
        """Return the configuration of these names; raise KeyError with a name that the chart does not have."""
        found = self._by_names.get(names)
        if found is None:
            nodes = {self.chart.by_name[name] for name in names} | {self.chart.root}
            make_room(self._by_names)
            found = self._by_names[names] = Configuration(frozenset(nodes))
        return found

    def beginning(self) -> MicrostepPlan:
        """Return the microstep that enters a machine."""
        return self.forced_plan(self.nothing, set(), StateSets(self.chart, {}).beginning(), {})

    def end(self, start: Configuration) -> MicrostepPlan:
        """Return the microstep that exits every state (`exitInterpreter`)."""
        return self.forced_plan(start, start.nodes, set(), {})

    def forced_plan(
        self, start: Configuration, left: AbstractSet[StateNode], entered: AbstractSet[StateNode], history: History
    ) -> MicrostepPlan:
        """Return a microstep that exits and enters these states without any transition."""
        return self._make(start, (), left, entered, history)

    def plan(self, start: Configuration, enabled: tuple[CompiledTransition, ...], history: History) -> MicrostepPlan:
        """Return the microstep that takes these enabled transitions from `start`, without those that others preempt.

        `history` has the states that the history states remember.
        """
        # A plan enters other states if histories remember others
        key = (enabled, *history.items()) if self.chart.has_history else enabled
        found = start.plans.get(key)
        if found is None:
            make_room(start.plans)
            sets = StateSets(self.chart, history)
            taken = sets.without_conflicts(enabled, start.nodes)
            left = sets.exit_set(taken, start.nodes)
            kept = {**history, **recorded(start.nodes, left)}  # histories recall the states that this microstep exits
            entered = StateSets(self.chart, kept, start.nodes - left).entry_set(sets.domains(taken))
            found = start.plans[key] = self._make(start, taken, left, entered, kept)
        return found

    def _make(
        self,
        start: Configuration,
        taken: tuple[CompiledTransition, ...],
        left: AbstractSet[StateNode],
        entered: AbstractSet[StateNode],
        history: History,
    ) -> MicrostepPlan:
        staying = start.nodes - left
        return MicrostepPlan(
            taken=taken,
            transitions=tuple(transition.definition for transition in taken),
            exits=exits(left, start.nodes),
            between=names_of(staying),
            entries=entries(entered, staying),
            exited=self._shared(tuple(node.name for node in exit_order(left) if node.path)),
            entered=self._shared(tuple(node.name for node in entry_order(entered) if node.path)),
            history={**history, **recorded(start.nodes, left)},
            target=self.configuration(frozenset(node.name for node in staying | entered if node.path)),
        )

    def _shared(self, names: tuple[str, ...]) -> tuple[str, ...]:
        """Return an equal stored tuple, else store this one: sharing saves memory in charts with many states."""
        make_room(self._names)
        return self._names.setdefault(names, names)


def make_room(cache: dict[Any, Any]) -> None:
    """Empty a cache that is full."""
    if len(cache) >= MAX_CACHE_ENTRIES:
        cache.clear()
