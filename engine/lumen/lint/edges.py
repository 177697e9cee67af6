"""Walks from the robot's start, checked against the ground of its hall: beyond the edge, the robot falls."""

from collections.abc import Generator, Iterable, Iterator, Mapping, Sequence
from math import cos, hypot, sin
from typing import NamedTuple

from lumen.language.actions import If, Parallel, PlacedAction, nested
from lumen.language.commands import GoTo, Move, Walk
from lumen.language.diagnostics import WARNING, Code, NodePath
from lumen.language.hall_places import HallPlace, HallPlaces
from lumen.language.machines import MachineDefinition, State, StateKind, Transition
from lumen.lint.ground import covered, ground_of, reach
from lumen.lint.hall_obstacles import GroundPoint, Obstacle
from lumen.project.draft import ProjectDraft

WALK_BEYOND_GROUND = Code("walk-beyond-ground", "robot", WARNING, "a walk leads off the ground of the hall")

MAX_WAYS = 2_000
"""The maximum number of visits to states that are followed, because a behaviour can have very many routes."""

STEP = 0.02
"""The distance between the points of a walk that are checked [m]."""


class PlaceOnGround(NamedTuple):
    """The robot's position [m] and its turn to the left [rad], both relative to its start."""

    x: float = 0.0
    y: float = 0.0
    turned: float = 0.0

    def after(self, walk: Walk) -> "PlaceOnGround":
        """Return the robot's position and turn after a walk from this position."""
        c, s = cos(self.turned), sin(self.turned)
        return PlaceOnGround(
            self.x + walk.x * c - walk.y * s, self.y + walk.x * s + walk.y * c, self.turned + walk.theta
        )


class Stray(NamedTuple):
    """A walk, and its first point that has no ground."""

    where: NodePath
    point: GroundPoint


def check(draft: ProjectDraft) -> None:
    """Report walks and places off the ground, if no `stage` keeps the feet on it."""
    settings, body = draft.settings, draft.body
    if settings is None or settings.stage is not None or len(settings.robots) > 1:
        return  # several robots start at different places
    if draft.main is None or body is None or not body.roles.base.row.moves:
        return
    parts = ground_of(draft, settings.hall)
    if not covered(parts, GroundPoint(0.0, 0.0)):
        return  # height fields and meshes are not read
    hint = f"stay on the ground, which extends {reach(parts)}, or write a `stage` in lumen.yaml"
    places = settings.section(HallPlaces).by_name
    for name, place in places.items():
        if not covered(parts, GroundPoint(place.x, place.y)):
            message = f"there is no ground at `{name}` in {settings.hall}: the robot would fall"
            draft.main(WALK_BEYOND_GROUND, ("places", name), message, hint, key=True)
    machine = draft.behaviors.get(settings.behavior)
    strays = dict(_Ways(machine, parts, places).strays()) if machine else {}
    for where, point in strays.items():
        x, y = round(point.x, 2) + 0.0, round(point.y, 2) + 0.0  # -0.0 becomes 0.0
        message = f"this walk leads off the ground, to x {x:.2f} m, y {y:.2f} m from the start"
        draft.report("behaviors", settings.behavior)(WALK_BEYOND_GROUND, (*where, "walk"), message, hint, key=True)


class _Ways:
    """Follows the routes on which a behaviour can lead the robot from its start, each until it repeats a walk.

    Guards are assumed to hold. After a walk that can be interrupted, or that another behaviour can request, the robot's
    position is unknown: nothing is reported for later walks.
    """

    def __init__(self, machine: MachineDefinition, parts: Sequence[Obstacle], places: Mapping[str, HallPlace]) -> None:
        self._machine, self._parts, self._places = machine, parts, places
        self._entered: dict[str, Iterable[str]] = {}

    def strays(self) -> Iterator[Stray]:
        """Yield each walk that leaves the ground; a walk occurs several times if several routes lead to it."""
        waiting: list[tuple[str, PlaceOnGround, frozenset[NodePath]]] = [("", PlaceOnGround(), frozenset())]
        seen = set(waiting)
        while waiting and len(seen) < MAX_WAYS:
            path, pose, before = waiting.pop()
            state, made = self._machine.states[path], set(before)
            after = yield from self._begun(state.entry, pose, made)
            after = yield from self._block(state.do, after, made)
            if after is None or (any(_moves(state.do)) and (state.children or state.invoke)):
                continue
            walks = any(_moves(state.do))
            for transition in self._transitions(state):
                if not walks or (transition.event.startswith("done.") and transition in state.transitions):
                    then = yield from self._begun(transition.actions, after, made)
                    waiting += self._new(transition.targets, then, made, seen)
            if not state.invoke:
                waiting += self._new(self._within(state), after, made, seen)

    @staticmethod
    def _new(
        targets: Iterable[str],
        pose: PlaceOnGround | None,
        made: set[NodePath],
        seen: set[tuple[str, PlaceOnGround, frozenset[NodePath]]],
    ) -> list[tuple[str, PlaceOnGround, frozenset[NodePath]]]:
        following = [(target, pose, frozenset(made)) for target in targets] if pose is not None else []
        fresh = [visit for visit in following if visit not in seen]
        seen.update(fresh)
        return fresh

    def _begun(
        self, steps: Sequence[PlacedAction], pose: PlaceOnGround | None, made: set[NodePath]
    ) -> Generator[Stray, None, PlaceOnGround | None]:
        """Follow actions that run without a wait; return the robot's pose, None (unknown) if any action is a walk."""
        after = yield from self._block(steps, pose, made)
        return None if any(_moves(steps)) else after

    def _block(
        self, steps: Iterable[PlacedAction], pose: PlaceOnGround | None, made: set[NodePath]
    ) -> Generator[Stray, None, PlaceOnGround | None]:
        """Follow actions in their order; return the robot's pose after them, None if it is unknown."""
        for step in steps:
            if pose is None:
                return None
            match step.action:
                case Walk() as walk:
                    pose = yield from self._walk(step.where, pose, pose.after(walk), made)
                case GoTo(to) if (place := self._places.get(to)) and place.heading is not None:
                    there = PlaceOnGround(place.x, place.y, place.heading)
                    pose = yield from self._walk(step.where, pose, there, made)
                case If(then=then, otherwise=otherwise) if any(_moves((step,))):
                    for branch in (then, otherwise):
                        yield from self._block(branch, pose, made)
                    return None
                case Parallel(branches) if any(_moves((step,))):
                    moving = [branch for branch in branches if any(_moves((branch,)))]
                    pose = (yield from self._block(moving, pose, made)) if len(moving) == 1 else None
                case _ if any(_moves((step,))):
                    return None
        return pose

    def _walk(
        self, where: NodePath, begin: PlaceOnGround, end: PlaceOnGround, made: set[NodePath]
    ) -> Generator[Stray, None, PlaceOnGround | None]:
        count = max(1, min(round(hypot(end.x - begin.x, end.y - begin.y) / STEP), 10_000))
        points = (
            GroundPoint(begin.x + (end.x - begin.x) * i / count, begin.y + (end.y - begin.y) * i / count)
            for i in range(1, count + 1)
        )
        if where in made:
            return None
        made.add(where)
        if stray := next((point for point in points if not covered(self._parts, point)), None):
            yield Stray(where, stray)
            return None
        return end

    def _transitions(self, state: State) -> Iterator[Transition]:
        at: str | None = state.path
        while at is not None:
            yield from self._machine.states[at].transitions
            at = self._machine.states[at].parent

    def _within(self, state: State) -> Iterable[str]:
        """Return the states that are entered with a state; none if several can walk at the same time."""
        if state.kind is not StateKind.PARALLEL:
            return state.initial
        if state.path not in self._entered:
            self._entered[state.path] = state.children if sum(map(self._walks, state.children)) <= 1 else ()
        return self._entered[state.path]

    def _walks(self, path: str) -> bool:
        """Return whether an action or an invoked behaviour in a state can make the robot walk."""
        state = self._machine.states[path]
        blocks = (state.entry, state.do, state.exit, *(t.actions for t in state.transitions))
        return (
            bool(state.invoke) or any(any(_moves(block)) for block in blocks) or any(map(self._walks, state.children))
        )


def _moves(steps: Sequence[PlacedAction]) -> Iterator[bool]:
    """Yield for each action, including nested ones, whether it makes the robot walk."""
    return (isinstance(step.action, Walk | GoTo | Move) for step in nested(tuple(steps)))
