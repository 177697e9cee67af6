"""Properties that do not hold in every reachable configuration, each with the shortest way to a counterexample.

A deadline is checked from each configuration in which `whenever` becomes true, as long as nothing comes from outside:
timers end in order, and the robot completes each command immediately, or fails.
"""

from collections import deque
from collections.abc import Iterator, Mapping
from typing import NamedTuple

from lumen.errors import LumenError
from lumen.insight.exploration.findings import ExplorationFinding, PathStep
from lumen.insight.exploration.search import SearchNode, StateSpaceSearch, leaves, still
from lumen.insight.exploration.stimuli import Stimulus, StimulusKind
from lumen.language.commands import BodyCommand
from lumen.language.machines import MachineDefinition
from lumen.language.nanoseconds import nanoseconds
from lumen.language.properties import Property
from lumen.statechart import Snapshot, step
from lumen.statechart.nesting import innermost_names
from lumen.statechart.property_monitor import holds

MAX_QUIET_STEPS = 2_000
"""The maximum number of steps that are examined from one configuration on."""


class QuietRun(NamedTuple):
    """The end of a run without input from outside."""

    snapshot: Snapshot
    commands: Mapping[str, BodyCommand]
    """The commands in progress, by their ids."""
    path: tuple[PathStep, ...] = ()
    """The steps to the end."""


def property_findings(machine: MachineDefinition, search: StateSpaceSearch) -> Iterator[ExplorationFinding]:
    """Yield a finding for each property of the machine that does not hold."""
    for property in machine.properties:
        broken = search.violations.get(property.name)
        if broken:
            way = [*_path(machine, broken.parent), _step(machine, broken.stimulus, broken.snapshot)]
            yield _finding(machine, property, broken.snapshot, tuple(way), 0.0)
        elif property.eventually:
            ways = (_late(machine, search, property, node) for node in _triggers(machine, search, property))
            if found := next((way for way in ways if way), None):
                run, node = found
                way = [*_path(machine, node), *run.path]
                yield _finding(machine, property, run.snapshot, tuple(way), property.within + 1.0)


def _triggers(machine: MachineDefinition, search: StateSpaceSearch, property: Property) -> list[SearchNode]:
    """Return the configurations in which `whenever` becomes true, nearest first."""
    condition = property.whenever
    if condition is None:
        return [search.first]
    asked = {node: holds(machine, condition, node.snapshot) for node in search.nodes.values()}
    fresh = [node for node in search.nodes.values() if asked[node] and not (node.parent and asked[node.parent])]
    return sorted(fresh, key=lambda node: node.cost)


def _late(
    machine: MachineDefinition, search: StateSpaceSearch, property: Property, node: SearchNode
) -> tuple[QuietRun, SearchNode] | None:
    """Return a run that misses the deadline, with its first configuration; None if MAX_QUIET_STEPS steps show none."""
    assert property.eventually is not None
    deadline = nanoseconds(node.snapshot.at) + nanoseconds(property.within)
    ahead, seen = deque([QuietRun(node.snapshot, node.commands)]), set[object]()
    while ahead and len(seen) < MAX_QUIET_STEPS:
        run = ahead.popleft()
        key = (search.abstraction.key(run.snapshot), run.snapshot.at)
        if key in seen or holds(machine, property.eventually, run.snapshot):
            continue
        seen.add(key)
        following = [s for s in _quiet(search, run) if nanoseconds(s.event.at) <= deadline]
        if not following:
            return run, node
        for stimulus in following:
            try:
                taken = step(machine, run.snapshot, stimulus.event)
            except LumenError:  # reported as restless by the search
                continue
            path = (*run.path, _step(machine, stimulus, taken.snapshot))
            ahead.append(QuietRun(taken.snapshot, still(run.commands, taken.commands, stimulus), path))
    return None


def _quiet(search: StateSpaceSearch, run: QuietRun) -> list[Stimulus]:
    """Return the next stimuli without input from outside: the robot's answers, else the timer that is due first."""
    every = list(search.stimuli.of(run.snapshot, run.commands))
    answers = [s for s in every if s.kind in (StimulusKind.DONE, StimulusKind.FAILED)]
    timers = sorted((s for s in every if s.kind is StimulusKind.TIME), key=lambda s: s.event.at)
    return answers or timers[:1]


def _path(machine: MachineDefinition, node: SearchNode | None) -> list[PathStep]:
    return [_step(machine, each.stimulus, each.snapshot) for each in node.path()] if node else []


def _step(machine: MachineDefinition, stimulus: Stimulus | None, snapshot: Snapshot) -> PathStep:
    return PathStep(stimulus, tuple(innermost_names(machine, snapshot)))


def _finding(
    machine: MachineDefinition, property: Property, snapshot: Snapshot, path: tuple[PathStep, ...], patience: float
) -> ExplorationFinding:
    state = next(leaves(machine, snapshot.configuration), "")
    condition = property.always or property.eventually
    assert condition is not None
    late = f" within {property.within:g} s" if property.eventually else ""
    message = f"`{property.name}`: `{condition.shown}` does not hold in `{machine.states[state].name}`{late}"
    return ExplorationFinding("property", state, message, path, property.where, patience)
