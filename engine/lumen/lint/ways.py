"""Ways through the hall: places at which the robot can't stand, and straight ways through solid objects."""

from collections.abc import Iterator, Mapping
from itertools import pairwise
from typing import NamedTuple

from lumen.language.actions import nested
from lumen.language.commands import GoTo
from lumen.language.diagnostics import WARNING, Code, NodePath
from lumen.language.hall_places import HallPlaces
from lumen.language.machines import MachineDefinition, State, StateKind
from lumen.lint.hall_obstacles import GroundPoint, Obstacle, nearest, obstacles
from lumen.project.draft import ProjectDraft

BLOCKED_PLACE = Code(
    "blocked-place", "robot", WARNING, "a place is inside a solid object of the hall, or too close to one"
)
BLOCKED_WAY = Code("blocked-way", "robot", WARNING, "the straight way from one place to the next is blocked")

ROOM_TO_STAND, ROOM_TO_PASS = 0.4, 0.2
"""The free distance [m] that the robot needs to set out from a place, and to pass an object with its arms."""

START = ""
"""The name of the robot's start."""


class PlacedWalk(NamedTuple):
    """A walk to a place, and the path of its action."""

    to: str
    where: NodePath


def check(draft: ProjectDraft) -> None:
    """Report places and ways that are blocked in the project's hall."""
    if draft.settings is None or draft.main is None:
        return
    named = draft.settings.section(HallPlaces).by_name
    if not named:
        return
    file = f"models/{draft.settings.hall}"
    content = draft.files.get(file) or draft.lent.get(file)
    solid = obstacles(content) if content else ()
    places = {name: GroundPoint(place.x, place.y) for name, place in named.items()}
    shut = set()
    for name, point in places.items():
        room = nearest(solid, point, point)
        if room < ROOM_TO_STAND:
            shut.add(name)
            what = "inside a solid object" if not room else f"{room:.2f} m from a solid object"
            hint = f"put it at least {ROOM_TO_STAND:g} m away: closer than that, the robot does not start to walk"
            draft.main(BLOCKED_PLACE, ("places", name), f"`{name}` is {what} in {draft.settings.hall}", hint, key=True)
    for behavior, machine in draft.behaviors.items():
        _ways(draft, behavior, machine, {START: GroundPoint(0.0, 0.0), **places}, solid, shut)


def _ways(
    draft: ProjectDraft,
    behavior: str,
    machine: MachineDefinition,
    points: Mapping[str, GroundPoint],
    solid: tuple[Obstacle, ...],
    shut: set[str],
) -> None:
    told = set()
    for before, walk in sorted(_followers(machine), key=lambda pair: (str(pair[1].where), pair[0])):
        pair = frozenset((before, walk.to))
        if before == walk.to or pair in told or walk.to not in points or before not in points or pair & shut:
            continue
        room = nearest(solid, points[before], points[walk.to])
        if room < ROOM_TO_PASS:
            told.add(pair)
            begin = f"`{before}`" if before else "the start"
            how = "leads through" if not room else f"passes {room:.2f} m from"
            hint = "put a place beside the object, and walk there first"
            message = f"the straight way from {begin} to `{walk.to}` {how} a solid object in the hall"
            draft.report("behaviors", behavior)(BLOCKED_WAY, (*walk.where, "walk", "to"), message, hint)


def _followers(machine: MachineDefinition) -> set[tuple[str, PlacedWalk]]:
    """Return pairs of a place, or the start, and a walk that can be the next walk from there.

    Guards are ignored. After a walk to a computed place the position is unknown, so there are no pairs for it.
    """
    walks = {path: _walks(state) for path, state in machine.states.items()}
    found: set[tuple[str, PlacedWalk]] = set()
    for path, rows in walks.items():
        found |= {(a.to, b) for a, b in pairwise(rows)}
        if rows:
            found |= {(rows[-1].to, walk) for walk in _next(machine, walks, _left_for(machine, path))}
    return found | {(START, walk) for walk in _next(machine, walks, [""])}


def _next(machine: MachineDefinition, walks: Mapping[str, list[PlacedWalk]], begin: list[str]) -> Iterator[PlacedWalk]:
    """Yield the first walks that can happen when these states are entered."""
    waiting, seen = list(begin), set()
    while waiting:
        path = waiting.pop()
        if path in seen:
            continue
        seen.add(path)
        state = machine.states[path]
        if walks[path]:
            yield walks[path][0]
            continue
        waiting += state.children if state.kind is StateKind.PARALLEL else state.initial
        waiting += _left_for(machine, path)


def _left_for(machine: MachineDefinition, path: str) -> list[str]:
    """Return the targets of the transitions of a state and of its ancestors."""
    found: list[str] = []
    at: str | None = path
    while at is not None:
        state = machine.states[at]
        found += [target for transition in state.transitions for target in transition.targets]
        at = state.parent
    return found


def _walks(state: State) -> list[PlacedWalk]:
    """Return the walks of a state to places, in the order of the file."""
    rows = [step for block in (state.entry, state.do) for step in nested(block)]
    return [PlacedWalk(step.action.to, step.where) for step in rows if isinstance(step.action, GoTo)]
