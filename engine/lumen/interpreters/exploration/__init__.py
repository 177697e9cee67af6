"""Walks a behaviour through everything that can happen, and tells where it would never get out again.

What counts as one configuration is said in `abstraction`, what can happen in `moves`, what events carry in `samples`.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any, Literal

from lumen.interpreters.exploration.moves import Kind, Move
from lumen.interpreters.exploration.walking import Spot, Walk, leading, leaves
from lumen.language import machines
from lumen.language.machines import Machine, Transition

__all__ = ["Exploration", "Finding", "Kind", "Move", "Stay", "explore"]

BOUND = 10_000


@dataclass(frozen=True)
class Stay:
    """A stay on the way to a finding: the move that led there (None at the beginning), and the states then active."""

    move: Move | None
    states: frozenset[str]


@dataclass(frozen=True)
class Finding:
    """Something that should not be: a dead end, no way back to `home`, or a machine that never comes to rest.

    `state` is the path of the state it is about, `way` the shortest one there.
    """

    kind: Literal["dead-end", "no-way-back", "restless"]
    state: str
    message: str
    way: tuple[Stay, ...]


@dataclass(frozen=True)
class Exploration:
    """What came of a walk; `waiting` are configurations that its bound left out.

    `never_entered` and `never_taken` are states and transitions that it did not come upon: what it does not see, or
    what can't be.
    """

    findings: tuple[Finding, ...]
    configurations: int
    steps: int
    waiting: int
    never_entered: tuple[str, ...] = ()
    never_taken: tuple[Transition, ...] = ()

    @property
    def complete(self) -> bool:
        return not self.waiting


def explore(
    machine: Machine,
    events: Mapping[str, Any],
    *,
    bound: int = BOUND,
    home: str = "",
    language: str = "",
    epoch: float = 0.0,
) -> Exploration:
    """Walk every configuration that can be reached, up to `bound` of them.

    `events` are those that may come from outside, each with the JSON Schema of its data. `home` is the state to come
    back to; without it, each state of the beginning that has others beside it. What the bound left out may lead
    anywhere: nothing is found that depends on it.
    """
    walk = Walk(machine, events, language=language, epoch=epoch)
    walk.go(bound)
    spots = list(walk.spots.values())
    dead = list(_dead_ends(machine, walk, spots))
    homes = [home] if home else [machine.states[p].name for p in leaves(machine, walk.first.names)]
    lost = [finding for name in homes for finding in _no_way_back(machine, walk, spots, name)]
    known = {finding.state for finding in dead}
    found = [*_restless(machine, spots), *dead, *(f for f in lost if f.state not in known)]
    states = (s for s in machine.states.values() if s.path and s.kind is not machines.Kind.HISTORY)
    return Exploration(
        tuple(found),
        walk.walked,
        walk.steps,
        walk.waiting,
        tuple(s.path for s in states if s.name not in walk.entered),
        tuple(t for s in machine.states.values() for t in s.transitions if t.where not in walk.taken),
    )


def _restless(machine: Machine, spots: list[Spot]) -> Iterator[Finding]:
    for path, spot in _cheapest(machine, [s for s in spots if s.restless]).items():
        yield _finding("restless", path, spot.restless, spot)


def _dead_ends(machine: Machine, walk: Walk, spots: list[Spot]) -> Iterator[Finding]:
    """Where no event, time or answer leads to other states, and the machine is not at its end."""
    leaving = {id(s) for s in spots if not s.walked or s.restless or any(e.names != s.names for e in s.exits)}
    free = leading(spots, leaving, inside=True)
    stuck = [s for s in spots if id(s) not in free and not walk.finished(s)]
    beginning, told = set(leaves(machine, walk.first.names)), set[str]()
    for spot in sorted(stuck, key=lambda s: s.cost):
        paths = [p for p in leaves(machine, spot.names) if p not in beginning] or list(leaves(machine, spot.names))
        if not told.issuperset(paths):
            told.update(paths)
            names = " with ".join(f"`{machine.states[path].name or machine.id}`" for path in paths)
            yield _finding("dead-end", paths[-1], f"nothing leads out of {names}", spot)


def _no_way_back(machine: Machine, walk: Walk, spots: list[Spot], home: str) -> Iterator[Finding]:
    """Where a state can't be reached any more, nor the machine's end."""
    goals = {id(s) for s in spots if home in s.names or not s.walked or s.restless or walk.finished(s)}
    reached = leading(spots, goals)
    lost = [s for s in spots if id(s) not in reached]
    region = _region(machine, home)
    for path, spot in _cheapest(machine, lost, region).items():
        name = machine.states[path].name or machine.id
        elsewhere = any(name in s.names for s in spots if id(s) in reached)
        message = f"from `{name}` there is {'not always a' if elsewhere else 'no'} way back to `{home}`"
        yield _finding("no-way-back", path, message, spot)


def _cheapest(machine: Machine, spots: list[Spot], region: str = "") -> dict[str, Spot]:
    """For each innermost state of a region (of all, where it is not active) the nearest of these spots."""
    found: dict[str, Spot] = {}
    for spot in sorted(spots, key=lambda s: s.cost):
        paths = list(leaves(machine, spot.names))
        inside = [p for p in paths if not region or p == region or p.startswith(f"{region}.")]
        for path in inside or paths:
            found.setdefault(path, spot)
    return found


def _region(machine: Machine, name: str) -> str:
    """The region of the nearest parallel state in which a state lies; empty where there is none."""
    path = next(s.path for s in machine.states.values() if s.name == name)
    while (parent := machine.states[path].parent) is not None:
        if machine.states[parent].kind is machines.Kind.PARALLEL:
            return path
        path = parent
    return ""


def _finding(kind: Literal["dead-end", "no-way-back", "restless"], path: str, message: str, spot: Spot) -> Finding:
    return Finding(kind, path, message, tuple(Stay(s.move, s.names) for s in spot.way()))
