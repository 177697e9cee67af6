"""The fast path: steps that happen again are taken by functions written for them, two to five times as fast.

The whole algorithm makes an ExecutionContext and finds out what an event means where the machine stands; most of that
is the same each time. What happens for the second time is written as a function of its own (`step_writer`). It decides
nothing that the algorithm would not, and where anything is not plain, a failing expression included, it gives up
without a trace: then the whole algorithm takes the step from its beginning. What happens once is never written.
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
"""How many ways through the guards are written into one function; of more, each gets its own when it is gone again."""


def whole(snapshot: Snapshot, event: Event) -> None:
    """Stands for what is left to the whole algorithm."""


class FastPaths:
    """The functions of a chart that are written so far, by event and configuration, and by where a `do` stands."""

    def __init__(self, planner: MicrostepPlanner) -> None:
        self.planner = planner
        self.paths: dict[str, dict[frozenset[str], WrittenStep]] = {}
        self.answers: dict[tuple[Any, ...], WrittenStep] = {}

    def step(self, snapshot: Snapshot, event: Event) -> Step | None:
        """The step of this event, None where it is not plain, or has not happened before."""
        try:
            play = self.paths[event[0]][snapshot[0]]
        except KeyError:
            play = self._found(snapshot, event)
        return play(snapshot, event)

    def _found(self, snapshot: Snapshot, event: Event) -> WrittenStep:
        """What is not among the paths: an answer, or what has not happened yet.

        What says where the robot is, or what a controller or another robot makes of the context, changes more than
        the states.
        """
        name, names = event.name, snapshot.configuration
        if ".command." in name:
            return whole if result_of(event.data) is not None else self._answered(snapshot, name)
        if name in (ARRIVED, LEFT, SHARED_EVENT) or name.startswith(CONTROLLER_EVENT):
            return whole
        make_room(self.paths)
        paths = self.paths.setdefault(name, {})
        return noted(paths, names, lambda: self._written(names, name))

    def _written(self, names: frozenset[str], name: str) -> WrittenStep | None:
        start = self.planner.configuration(names)
        if name.startswith("after."):  # a timer, which has the same `sendid`
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
        """What a `done.command.*` does: it resumes the `do` that awaits it, and if none does, nothing."""
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
    """Notes in a cache that something has happened: when it happens again, the function for it is written."""

    def again(snapshot: Snapshot, event: Event) -> Step | None:
        cache[key] = play = write() or whole
        return play(snapshot, event)

    make_room(cache)
    cache[key] = again
    return whole


def _ways(candidates: Candidates) -> int:
    """In how many ways the guards may turn out."""
    groups = (*candidates, *(group for later in candidates.later for group in later))
    return prod(sum(t.guard is not None for t in group) + 1 for group in groups)
