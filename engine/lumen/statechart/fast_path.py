"""The fast path: recurring steps are taken by functions generated for them, two to five times as fast.

The full algorithm makes an ExecutionContext and determines what an event means in the current configuration, mostly
with the same result each time. On its second occurrence a step is generated as a function of its own (`step_writer`).
That function makes no decision that the algorithm would not make. In any case that it does not cover, such as a failing
expression, it returns None without side effects, and the full algorithm computes the step from the beginning. Nothing
is generated for a step that occurs once.
"""

from collections.abc import Callable
from math import prod
from typing import Any

from lumen.language.controllers import CONTROLLER_EVENT
from lumen.language.events import ARRIVED, LEFT, Event
from lumen.language.shared import SHARED_EVENT
from lumen.statechart.chart import CompiledTransition
from lumen.statechart.command_ids import result_of
from lumen.statechart.plans import NO_CANDIDATES, Candidates, MicrostepPlanner, make_room
from lumen.statechart.step_code import WrittenStep
from lumen.statechart.step_writer import StepWriter
from lumen.statechart.values import Awaiting, Fork, Snapshot, Step, Within

MAX_WAYS = 2
"""The greatest number of combinations of guard results in one function; with more, each gets its own function."""


def whole(snapshot: Snapshot, event: Event) -> None:
    """Placeholder for a step that the full algorithm must take; returns None."""


class FastPaths:
    """The functions generated for a chart so far, by event and configuration, and by the position of a `do`."""

    def __init__(self, planner: MicrostepPlanner) -> None:
        self.planner = planner
        self.paths: dict[str, dict[frozenset[str], WrittenStep]] = {}
        self.answers: dict[tuple[Any, ...], WrittenStep] = {}

    def step(self, snapshot: Snapshot, event: Event) -> Step | None:
        """Return the step of this event; None if the full algorithm must take it, as on its first occurrence."""
        try:
            play = self.paths[event[0]][snapshot[0]]
        except KeyError:
            play = self._found(snapshot, event)
        return play(snapshot, event)

    def _found(self, snapshot: Snapshot, event: Event) -> WrittenStep:
        """Return the function for an event that is not among the paths.

        It is an answer, or a new combination of event and states. Events that change the robot's place or context keys
        are left to the full algorithm, because they change more than states.
        """
        name, names = event.name, snapshot.configuration
        if ".command." in name:
            # A result becomes data of `done.do.*`, which a generated step does not compute
            has_result = event.data is not None and result_of(event.data) is not None
            return whole if has_result else self._answered(snapshot, name)
        if name in (ARRIVED, LEFT, SHARED_EVENT) or name.startswith(CONTROLLER_EVENT):
            return whole
        make_room(self.paths)
        paths = self.paths.setdefault(name, {})
        return noted(paths, names, lambda: self._written(names, name))

    def _written(self, names: frozenset[str], name: str) -> WrittenStep | None:
        start = self.planner.configuration(names)
        if name.startswith("after."):  # the event of a timer, which has the same `sendid`
            return StepWriter(self.planner, start).elapsed(name)
        candidates = start.candidates(name)
        if _ways(candidates) <= MAX_WAYS:
            return StepWriter(self.planner, start).heard(candidates)
        parts: dict[tuple[CompiledTransition, ...], WrittenStep] = {}

        def apart(enabled: tuple[CompiledTransition, ...]) -> WrittenStep:
            noted(parts, enabled, lambda: StepWriter(self.planner, start).taken(enabled))
            return lambda snapshot, event: parts[enabled](snapshot, event)

        return StepWriter(self.planner, start, apart).heard(candidates)

    def _answered(self, snapshot: Snapshot, name: str) -> WrittenStep:
        """Return the function for an answer to a command; only `done` has one, which resumes the awaiting `do`."""
        kind, _, id = name.partition(".command.")
        if kind != "done" or not (id[:1] in ("c", "d") and id[1:].isdecimal()):
            return whole
        key: tuple[Any, ...] = (snapshot.configuration,)
        for path, position in snapshot.doing.items():
            place: list[Any] = [path]
            inner: Any = position
            while type(inner) is Within:
                place += inner[:2]
                inner = inner[2]
            if type(inner) is Awaiting:
                if inner[0] == id:
                    key += (None, *place)
            elif any(type(branch) is Fork or type(branch) is Within for branch in inner[0]):
                return whole
            else:
                ids = [branch and branch[0] for branch in inner[0]]
                if id in ids:
                    key += (ids.index(id), *place, *(branch is None for branch in ids))
        return self.answers.get(key) or noted(self.answers, key, lambda: self._resumed(key, snapshot))

    def _resumed(self, key: tuple[Any, ...], snapshot: Snapshot) -> WrittenStep | None:
        names, *place = key
        writer = StepWriter(self.planner, self.planner.configuration(names))
        if not place:
            return writer.heard(NO_CANDIDATES)
        branch, path, *_ = place
        return writer.resumed(self.planner.chart.nodes[path], snapshot.doing[path], branch)


def noted(cache: dict[Any, WrittenStep], key: Any, write: Callable[[], WrittenStep | None]) -> WrittenStep:
    """Record the first occurrence of a key and return `whole`; at the second, `write` generates the function."""

    def again(snapshot: Snapshot, event: Event) -> Step | None:
        cache[key] = play = write() or whole
        return play(snapshot, event)

    make_room(cache)
    cache[key] = again
    return whole


def _ways(candidates: Candidates) -> int:
    """Return the number of combinations of results that the guards can have."""
    groups = (*candidates, *(group for later in candidates.later for group in later))
    return prod(sum(t.guard is not None for t in group) + 1 for group in groups)
