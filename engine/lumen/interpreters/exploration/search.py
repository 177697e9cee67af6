"""The walk through everything that can happen, the likeliest ways first."""

from collections.abc import Iterator, Mapping
from heapq import heappop, heappush
from typing import Any

from lumen.errors import LumenError
from lumen.interpreters.exploration.abstraction import Abstraction, ConfigurationKey
from lumen.interpreters.exploration.stimuli import Stimulus, StimulusFinder
from lumen.interpreters.statechart import Snapshot, Step, initial, step
from lumen.interpreters.statechart.answers import answer_of
from lumen.interpreters.statechart.compiled_machine import compiled
from lumen.language.commands import BodyCommand, Command, Start
from lumen.language.diagnostics import NodePath
from lumen.language.machines import MachineDefinition


class SearchNode:
    """A configuration come upon: one snapshot that stands for it, the cheapest way to it, and where it leads.

    `restless` says how the machine never comes to rest after the move `endless`.
    """

    __slots__ = ("before", "commands", "cost", "endless", "exits", "move", "restless", "snapshot", "walked")

    def __init__(
        self,
        snapshot: Snapshot,
        commands: Mapping[str, BodyCommand],
        cost: int,
        before: "SearchNode | None",
        move: Stimulus | None,
    ) -> None:
        self.snapshot, self.commands, self.cost = snapshot, commands, cost
        self.before, self.move = before, move
        self.exits: list[SearchNode] = []
        self.restless = ""
        self.endless: Stimulus | None = None
        self.walked = False

    @property
    def names(self) -> frozenset[str]:
        """The active states."""
        return self.snapshot.configuration

    def way(self) -> list["SearchNode"]:
        """The spots on the way here, this one included."""
        spot: SearchNode | None = self
        found = []
        while spot:
            found.append(spot)
            spot = spot.before
        return found[::-1]


class StateSpaceSearch:
    """Walks a machine up to so many configurations; `spots` are those come upon, in the order they were.

    `events` are those that may come from outside, each with the JSON Schema of its data.
    """

    def __init__(
        self, machine: MachineDefinition, events: Mapping[str, Any], *, language: str = "", epoch: float = 0.0
    ) -> None:
        self._machine = machine
        self._moves = StimulusFinder(machine, events)
        self._abstraction = Abstraction(machine)
        self._planner = compiled(machine).planner
        self.spots: dict[ConfigurationKey, SearchNode] = {}
        self.steps = 0
        self.walked = 0
        self.taken: set[NodePath] = set()
        self.entered: set[str] = set()
        self._waiting: list[tuple[int, int, SearchNode]] = []
        first = initial(machine, language=language, epoch=epoch)
        self.first = self._arrive(first, None, None)

    @property
    def waiting(self) -> int:
        """How many configurations were come upon and not walked from."""
        return len(self.spots) - self.walked

    def go(self, bound: int) -> Iterator[int]:
        """Walk on until there is nowhere to go, or from so many configurations; yields their number."""
        while self._waiting and self.walked < bound:
            cost, _, spot = heappop(self._waiting)
            if not spot.walked and cost == spot.cost:
                spot.walked = True
                self.walked += 1
                self._leave(spot)
                yield self.walked

    def finished(self, spot: SearchNode) -> bool:
        """Whether the machine has come to its end there."""
        return self._planner.configuration(spot.names).finished

    def _leave(self, spot: SearchNode) -> None:
        """Make every move there is from here."""
        if self.finished(spot):
            return
        for move in self._moves.of(spot.snapshot, spot.commands):
            self.steps += 1
            try:
                taken = step(self._machine, spot.snapshot, move.event)
            except LumenError as error:
                spot.endless = spot.endless or move
                spot.restless = spot.restless or str(error)
                continue
            if taken.snapshot is not spot.snapshot:
                spot.exits.append(self._arrive(taken, spot, move))

    def _arrive(self, taken: Step, before: SearchNode | None, move: Stimulus | None) -> SearchNode:
        self.taken.update(t.where for t in taken.transitions)
        self.entered.update(taken.entered)
        cost = (before.cost if before else 0) + (move.cost if move else 0)
        key = self._abstraction.key(taken.snapshot)
        spot = self.spots.get(key)
        if spot is None or (cost < spot.cost and not spot.walked):
            commands = _still(before.commands if before else {}, taken.commands, move)
            if spot is None:
                spot = self.spots[key] = SearchNode(taken.snapshot, commands, cost, before, move)
            else:
                spot.snapshot, spot.commands, spot.cost = taken.snapshot, commands, cost
                spot.before, spot.move = before, move
            heappush(self._waiting, (cost, len(self.spots) + self.steps, spot))
        return spot


def _still(
    commands: Mapping[str, BodyCommand], started: tuple[Command, ...], move: Stimulus | None
) -> dict[str, BodyCommand]:
    """The awaited commands by id, without the one just answered."""
    answer = answer_of(move.event) if move else None
    kept = {id: c for id, c in commands.items() if not (answer and id == answer.id)}
    return kept | {c.id: c.command for c in started if isinstance(c, Start) and c.id.startswith("d")}


def reaching(spots: list[SearchNode], goals: set[int], *, inside: bool = False) -> set[int]:
    """The spots (by identity) from which one of the goals can be reached.

    With `inside` only ways count on which the active states stay the same.
    """
    before: dict[int, list[SearchNode]] = {}
    for spot in spots:
        for exit in spot.exits:
            if not inside or exit.names == spot.names:
                before.setdefault(id(exit), []).append(spot)
    found, ahead = set(goals), list(goals)
    while ahead:
        for spot in before.get(ahead.pop(), ()):
            if id(spot) not in found:
                found.add(id(spot))
                ahead.append(id(spot))
    return found


def leaves(machine: MachineDefinition, names: frozenset[str]) -> Iterator[str]:
    """The innermost of the active states, by path, in the order of the file."""
    for state in machine.states.values():
        if state.name in names and not any(machine.states[child].name in names for child in state.children):
            yield state.path
