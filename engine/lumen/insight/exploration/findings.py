"""The faults among the configurations found, each with the path to it: dead ends, no way back, no rest."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

from lumen.insight.exploration.search import SearchNode, StateSpaceSearch, leaves, reaching
from lumen.insight.exploration.stimuli import Stimulus
from lumen.language.diagnostics import NodePath
from lumen.language.machines import MachineDefinition, StateKind, is_within
from lumen.statechart.nesting import ID_SEPARATOR, innermost_names

FindingKind = Literal["dead-end", "no-way-back", "restless", "property"]


@dataclass(frozen=True)
class PathStep:
    """A step of the path to a finding."""

    stimulus: Stimulus | None
    """The stimulus that led to the states; None at the beginning."""
    states: tuple[str, ...]
    """The innermost states active after the stimulus, including those of invoked behaviours (`quiz/ask`)."""


@dataclass(frozen=True)
class ExplorationFinding:
    """A fault: a dead end, no way back to `home`, a machine that never rests, or a property that does not hold."""

    kind: FindingKind
    """The kind of fault."""
    state: str
    """The path of the state that the fault concerns."""
    message: str
    """The fault in words."""
    path: tuple[PathStep, ...]
    """The shortest path to the fault."""
    where: NodePath = ()
    """The path of the property in the file; empty for other faults."""
    patience: float = 0.0
    """The time [s] to wait at the end of the path until a property with a deadline fails; 0 for other faults."""


def findings(machine: MachineDefinition, search: StateSpaceSearch, home: str = "") -> list[ExplorationFinding]:
    """Return all faults; without a `home`, each innermost state of the beginning must be reachable again."""
    nodes = list(search.nodes.values())
    dead = list(_dead_ends(machine, search, nodes))
    homes = [home] if home else [machine.states[p].name for p in leaves(machine, search.first.names)]
    lost = [finding for name in homes for finding in _no_way_back(machine, search, nodes, name)]
    known = {finding.state for finding in dead}
    return [*_restless(machine, nodes), *dead, *(f for f in lost if f.state not in known)]


def _restless(machine: MachineDefinition, nodes: list[SearchNode]) -> Iterator[ExplorationFinding]:
    for path, node in _cheapest(machine, [s for s in nodes if s.restless]).items():
        yield _finding(machine, "restless", path, node.restless, node)


def _dead_ends(
    machine: MachineDefinition, search: StateSpaceSearch, nodes: list[SearchNode]
) -> Iterator[ExplorationFinding]:
    """Yield a finding for each state that no event, time or answer leaves, unless the machine has ended there."""
    leaving = {s for s in nodes if not s.expanded or s.restless or any(e.names != s.names for e in s.successors)}
    free = reaching(nodes, leaving, inside=True)
    stuck = [s for s in nodes if s not in free and not search.finished(s)]
    beginning, covered = set(leaves(machine, search.first.names)), set[str]()
    for node in sorted(stuck, key=lambda s: s.cost):
        paths = [p for p in leaves(machine, node.names) if p not in beginning] or list(leaves(machine, node.names))
        if not covered.issuperset(paths):
            covered.update(paths)
            inner = [name for name in innermost_names(machine, node.snapshot) if ID_SEPARATOR in name]
            names = " with ".join(f"`{n}`" for n in [*(machine.states[p].name or machine.id for p in paths), *inner])
            yield _finding(machine, "dead-end", paths[-1], f"no transition leads out of {names}", node)


def _no_way_back(
    machine: MachineDefinition, search: StateSpaceSearch, nodes: list[SearchNode], home: str
) -> Iterator[ExplorationFinding]:
    """Yield a finding for each state from which neither `home` nor the machine's end can be reached."""
    goals = {s for s in nodes if home in s.names or not s.expanded or s.restless or search.finished(s)}
    reached = reaching(nodes, goals)
    lost = [s for s in nodes if s not in reached]
    nearest = _cheapest(machine, lost, _region(machine, home))
    for path, node in sorted(nearest.items(), key=lambda item: _ahead(item[1])):  # the ends of paths come first
        name = machine.states[path].name or machine.id
        elsewhere = any(name in s.names for s in nodes if s in reached)
        message = f"from `{name}` there is {'not always a' if elsewhere else 'no'} way back to `{home}`"
        yield _finding(machine, "no-way-back", path, message, node)


def _ahead(node: SearchNode) -> int:
    """Return the number of nodes that can be reached from `node`, including itself."""
    found, ahead = {node}, [node]
    while ahead:
        fresh = [successor for successor in ahead.pop().successors if successor not in found]
        found.update(fresh)
        ahead += fresh
    return len(found)


def _cheapest(machine: MachineDefinition, nodes: list[SearchNode], region: str = "") -> dict[str, SearchNode]:
    """Return the cheapest node for each active innermost state, by the state's path.

    With `region`, only states in the region count, unless the region is inactive in a node.
    """
    found: dict[str, SearchNode] = {}
    for node in sorted(nodes, key=lambda s: s.cost):
        paths = list(leaves(machine, node.names))
        inside = [p for p in paths if is_within(p, region)]
        for path in inside or paths:
            found.setdefault(path, node)
    return found


def _region(machine: MachineDefinition, name: str) -> str:
    """Return the region of the nearest parallel state around a state; empty outside of parallel states."""
    path = next(s.path for s in machine.states.values() if s.name == name)
    while (parent := machine.states[path].parent) is not None:
        if machine.states[parent].kind is StateKind.PARALLEL:
            return path
        path = parent
    return ""


def _finding(
    machine: MachineDefinition, kind: FindingKind, path: str, message: str, node: SearchNode
) -> ExplorationFinding:
    steps = [PathStep(s.stimulus, tuple(innermost_names(machine, s.snapshot))) for s in node.path()]
    if kind == "restless":
        steps.append(PathStep(node.endless, steps[-1].states))
    return ExplorationFinding(kind, path, message, tuple(steps))
