"""The uniform-cost search through all possible stimuli: the likeliest paths first."""

from collections.abc import Iterator, Mapping
from heapq import heappop, heappush
from typing import Any, NamedTuple

from lumen.errors import LumenError
from lumen.insight.exploration.abstraction import Abstraction, ConfigurationKey
from lumen.insight.exploration.stimuli import Stimulus, StimulusFinder
from lumen.language.commands import BodyCommand, Command, Start
from lumen.language.diagnostics import NodePath
from lumen.language.machines import MachineDefinition
from lumen.statechart import Snapshot, Step, initial, step
from lumen.statechart.command_ids import answer_of
from lumen.statechart.compiled_machine import compiled
from lumen.statechart.property_monitor import holds


class SearchNode:
    """A configuration that was found: a snapshot that represents it, the cheapest path to it, and its successors.

    `restless` is the error if the machine never comes to rest after the stimulus `endless`; else it is empty.
    """

    __slots__ = ("commands", "cost", "endless", "expanded", "parent", "restless", "snapshot", "stimulus", "successors")

    def __init__(
        self,
        snapshot: Snapshot,
        commands: Mapping[str, BodyCommand],
        cost: int,
        parent: "SearchNode | None",
        stimulus: Stimulus | None,
    ) -> None:
        self.snapshot, self.commands, self.cost = snapshot, commands, cost
        self.parent, self.stimulus = parent, stimulus
        self.successors: list[SearchNode] = []
        self.restless = ""
        self.endless: Stimulus | None = None
        self.expanded = False

    @property
    def names(self) -> frozenset[str]:
        """The names of the active states."""
        return self.snapshot.configuration

    def path(self) -> list["SearchNode"]:
        """Return the nodes on the cheapest path to this node, which is the last of them."""
        node: SearchNode | None = self
        found = []
        while node:
            found.append(node)
            node = node.parent
        return found[::-1]


class BrokenProperty(NamedTuple):
    """The cheapest step found after which a property does not hold."""

    cost: int
    """The cost of the path that ends with the step."""
    parent: SearchNode | None
    """The node from which the step was taken; None for the first step."""
    stimulus: Stimulus | None
    snapshot: Snapshot
    """The snapshot after the step."""


class StateSpaceSearch:
    """The search through the configurations of a machine.

    `events` are those that can come from outside, each with the JSON Schema of its data.
    """

    def __init__(
        self,
        machine: MachineDefinition,
        events: Mapping[str, Any],
        *,
        language: str = "",
        epoch: float = 0.0,
        timezone: str = "",
    ) -> None:
        self._machine = machine
        self.stimuli = StimulusFinder(machine, events)
        self.abstraction = Abstraction(machine)
        self._planner = compiled(machine).planner
        self.nodes: dict[ConfigurationKey, SearchNode] = {}
        """The nodes found, by the keys of their configurations, in the order in which they were found."""
        self.steps = 0
        """The number of steps taken."""
        self.expanded = 0
        """The number of nodes expanded."""
        self.taken: set[NodePath] = set()
        """The paths of the transitions taken."""
        self.entered: set[str] = set()
        """The names of the states entered."""
        self.violations: dict[str, BrokenProperty] = {}
        """The cheapest violation of each property that must always hold, by the property's name."""
        self._waiting: list[tuple[int, int, SearchNode]] = []
        first = initial(machine, language=language, epoch=epoch, timezone=timezone)
        self.first = self._reach(first, None, None)

    @property
    def waiting(self) -> int:
        """The number of configurations that were found but not expanded."""
        return len(self.nodes) - self.expanded

    def expand(self, bound: int) -> Iterator[int]:
        """Expand nodes, the cheapest first, until `bound` of them are expanded; yield their number after each."""
        while self._waiting and self.expanded < bound:
            cost, _, node = heappop(self._waiting)
            if not node.expanded and cost == node.cost:
                node.expanded = True
                self.expanded += 1
                self._expand(node)
                yield self.expanded

    def finished(self, node: SearchNode) -> bool:
        """Return whether the machine has ended in that configuration."""
        return self._planner.configuration(node.names).finished

    def _expand(self, node: SearchNode) -> None:
        """Take a step for everything that can happen in a node."""
        if self.finished(node):
            return
        for stimulus in self.stimuli.of(node.snapshot, node.commands):
            self.steps += 1
            try:
                taken = step(self._machine, node.snapshot, stimulus.event)
            except LumenError as error:
                node.endless = node.endless or stimulus
                node.restless = node.restless or str(error)
                continue
            if taken.snapshot is not node.snapshot:
                node.successors.append(self._reach(taken, node, stimulus))

    def _watch(self, snapshot: Snapshot, cost: int, parent: SearchNode | None, stimulus: Stimulus | None) -> None:
        """Record the cheapest violation of each property that must always hold."""
        for property in self._machine.properties:
            known = self.violations.get(property.name)
            if (
                property.always
                and (known is None or cost < known.cost)
                and not holds(self._machine, property.always, snapshot)
            ):
                self.violations[property.name] = BrokenProperty(cost, parent, stimulus, snapshot)

    def _reach(self, taken: Step, parent: SearchNode | None, stimulus: Stimulus | None) -> SearchNode:
        self.taken.update(t.where for t in taken.transitions)
        self.entered.update(taken.entered)
        cost = (parent.cost if parent else 0) + (stimulus.cost if stimulus else 0)
        self._watch(taken.snapshot, cost, parent, stimulus)
        key = self.abstraction.key(taken.snapshot)
        node = self.nodes.get(key)
        if node is None or (cost < node.cost and not node.expanded):
            commands = still(parent.commands if parent else {}, taken.commands, stimulus)
            if node is None:
                node = self.nodes[key] = SearchNode(taken.snapshot, commands, cost, parent, stimulus)
            else:
                node.snapshot, node.commands, node.cost = taken.snapshot, commands, cost
                node.parent, node.stimulus = parent, stimulus
            heappush(self._waiting, (cost, len(self.nodes) + self.steps, node))
        return node


def still(
    commands: Mapping[str, BodyCommand], started: tuple[Command, ...], stimulus: Stimulus | None
) -> dict[str, BodyCommand]:
    """Return the awaited commands by id: with those just started, and without the one that the stimulus answers."""
    answer = answer_of(stimulus.event) if stimulus else None
    kept = {id: c for id, c in commands.items() if not (answer and id == answer.id)}
    return kept | {c.id: c.command for c in started if isinstance(c, Start) and c.id.startswith("d")}


def reaching(nodes: list[SearchNode], goals: set[SearchNode], *, inside: bool = False) -> set[SearchNode]:
    """Return the nodes from which one of the goals can be reached.

    With `inside`, only paths with unchanged active states count.
    """
    before: dict[SearchNode, list[SearchNode]] = {}
    for node in nodes:
        for successor in node.successors:
            if not inside or successor.names == node.names:
                before.setdefault(successor, []).append(node)
    found, ahead = set(goals), list(goals)
    while ahead:
        for node in before.get(ahead.pop(), ()):
            if node not in found:
                found.add(node)
                ahead.append(node)
    return found


def leaves(machine: MachineDefinition, names: frozenset[str]) -> Iterator[str]:
    """Yield the paths of the innermost active states, in the order of the file."""
    for state in machine.states.values():
        if state.name in names and not any(machine.states[child].name in names for child in state.children):
            yield state.path
