"""What should not be among the configurations walked: dead ends, no way back, no rest; and the way to each."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

from lumen.interpreters.exploration.search import SearchNode, StateSpaceSearch, leaves, reaching
from lumen.interpreters.exploration.stimuli import Stimulus
from lumen.interpreters.statechart.inside import ID_SEPARATOR, innermost
from lumen.language.machines import MachineDefinition, StateKind

FindingKind = Literal["dead-end", "no-way-back", "restless"]


@dataclass(frozen=True)
class PathStep:
    """A stay on the way to a finding: the move that led there (None at the beginning), and the states then active.

    `states` are the innermost ones, those of invoked behaviours (`quiz/ask`) included.
    """

    move: Stimulus | None
    states: tuple[str, ...]


@dataclass(frozen=True)
class ExplorationFinding:
    """Something that should not be: a dead end, no way back to `home`, or a machine that never comes to rest.

    `state` is the path of the state it is about, `way` the shortest one there.
    """

    kind: FindingKind
    state: str
    message: str
    way: tuple[PathStep, ...]


def findings(machine: MachineDefinition, walk: StateSpaceSearch, home: str = "") -> list[ExplorationFinding]:
    """Everything found on a walk; without a `home`, that is each innermost state of the beginning."""
    spots = list(walk.spots.values())
    dead = list(_dead_ends(machine, walk, spots))
    homes = [home] if home else [machine.states[p].name for p in leaves(machine, walk.first.names)]
    lost = [finding for name in homes for finding in _no_way_back(machine, walk, spots, name)]
    known = {finding.state for finding in dead}
    return [*_restless(machine, spots), *dead, *(f for f in lost if f.state not in known)]


def _restless(machine: MachineDefinition, spots: list[SearchNode]) -> Iterator[ExplorationFinding]:
    for path, spot in _cheapest(machine, [s for s in spots if s.restless]).items():
        yield _finding(machine, "restless", path, spot.restless, spot)


def _dead_ends(
    machine: MachineDefinition, walk: StateSpaceSearch, spots: list[SearchNode]
) -> Iterator[ExplorationFinding]:
    """Where no event, time or answer leads to other states, and the machine is not at its end."""
    leaving = {id(s) for s in spots if not s.walked or s.restless or any(e.names != s.names for e in s.exits)}
    free = reaching(spots, leaving, inside=True)
    stuck = [s for s in spots if id(s) not in free and not walk.finished(s)]
    beginning, told = set(leaves(machine, walk.first.names)), set[str]()
    for spot in sorted(stuck, key=lambda s: s.cost):
        paths = [p for p in leaves(machine, spot.names) if p not in beginning] or list(leaves(machine, spot.names))
        if not told.issuperset(paths):
            told.update(paths)
            inner = [name for name in innermost(machine, spot.snapshot) if ID_SEPARATOR in name]
            names = " with ".join(f"`{n}`" for n in [*(machine.states[p].name or machine.id for p in paths), *inner])
            yield _finding(machine, "dead-end", paths[-1], f"nothing leads out of {names}", spot)


def _no_way_back(
    machine: MachineDefinition, walk: StateSpaceSearch, spots: list[SearchNode], home: str
) -> Iterator[ExplorationFinding]:
    """Where a state can't be reached any more, nor the machine's end."""
    goals = {id(s) for s in spots if home in s.names or not s.walked or s.restless or walk.finished(s)}
    reached = reaching(spots, goals)
    lost = [s for s in spots if id(s) not in reached]
    nearest = _cheapest(machine, lost, _region(machine, home))
    for path, spot in sorted(nearest.items(), key=lambda item: _ahead(item[1])):  # what others only lead to is first
        name = machine.states[path].name or machine.id
        elsewhere = any(name in s.names for s in spots if id(s) in reached)
        message = f"from `{name}` there is {'not always a' if elsewhere else 'no'} way back to `{home}`"
        yield _finding(machine, "no-way-back", path, message, spot)


def _ahead(spot: SearchNode) -> int:
    """How many spots can be reached from this one."""
    found, ahead = {id(spot)}, [spot]
    while ahead:
        fresh = [exit for exit in ahead.pop().exits if id(exit) not in found]
        found.update(map(id, fresh))
        ahead += fresh
    return len(found)


def _cheapest(machine: MachineDefinition, spots: list[SearchNode], region: str = "") -> dict[str, SearchNode]:
    """For each innermost state of a region (of all, where it is not active) the nearest of these spots."""
    found: dict[str, SearchNode] = {}
    for spot in sorted(spots, key=lambda s: s.cost):
        paths = list(leaves(machine, spot.names))
        inside = [p for p in paths if not region or p == region or p.startswith(f"{region}.")]
        for path in inside or paths:
            found.setdefault(path, spot)
    return found


def _region(machine: MachineDefinition, name: str) -> str:
    """The region of the nearest parallel state in which a state lies; empty where there is none."""
    path = next(s.path for s in machine.states.values() if s.name == name)
    while (parent := machine.states[path].parent) is not None:
        if machine.states[parent].kind is StateKind.PARALLEL:
            return path
        path = parent
    return ""


def _finding(
    machine: MachineDefinition, kind: FindingKind, path: str, message: str, spot: SearchNode
) -> ExplorationFinding:
    way = [PathStep(s.move, tuple(innermost(machine, s.snapshot))) for s in spot.way()]
    if kind == "restless":
        way.append(PathStep(spot.endless, way[-1].states))
    return ExplorationFinding(kind, path, message, tuple(way))
