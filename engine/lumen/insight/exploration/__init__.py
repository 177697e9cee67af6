"""Explores everything that can happen to a behaviour, to find states with no way out.

`abstraction` defines when two snapshots count as one configuration, `stimuli` what can happen, and `samples` the data
of events.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from lumen.insight.exploration.findings import ExplorationFinding, PathStep, findings
from lumen.insight.exploration.properties import property_findings
from lumen.insight.exploration.search import StateSpaceSearch
from lumen.insight.exploration.stimuli import Stimulus, StimulusKind
from lumen.language import machines
from lumen.language.machines import MachineDefinition, Transition

__all__ = ["Exploration", "ExplorationFinding", "PathStep", "Stimulus", "StimulusKind", "explore"]

MAX_CONFIGURATIONS = 10_000
"""The default for the maximum number of configurations that are expanded."""


@dataclass(frozen=True)
class Exploration:
    """The result of a search."""

    findings: tuple[ExplorationFinding, ...]
    """The faults found."""
    configurations: int
    """The number of configurations that were expanded."""
    steps: int
    """The number of steps that were taken."""
    waiting: int
    """The number of configurations that were found but not expanded, because of the bound."""
    never_entered: tuple[str, ...] = ()
    """The paths of states that the search did not enter: unreachable, or beyond its bound or its samples of data."""
    never_taken: tuple[Transition, ...] = ()
    """The transitions that the search did not take, for the same reasons."""
    kept: tuple[str, ...] = ()
    """The names of the properties that hold in every configuration that was found."""

    @property
    def complete(self) -> bool:
        """Whether every configuration that was found was also expanded."""
        return not self.waiting


def explore(
    machine: MachineDefinition,
    events: Mapping[str, Any],
    *,
    bound: int = MAX_CONFIGURATIONS,
    home: str = "",
    language: str = "",
    epoch: float = 0.0,
    timezone: str = "",
    progress: Callable[[int, int], None] = lambda expanded, waiting: None,
) -> Exploration:
    """Explore the configurations that can be reached, and expand up to `bound` of them.

    `events` are those that can come from outside, each with the JSON Schema of its data. `home` is the name of the
    state that must stay reachable; if it is empty, each innermost state active at the beginning must. A configuration
    beyond the bound may lead anywhere, so no finding depends on one. `progress` is called with the numbers of
    configurations that were expanded and that wait.
    """
    search = StateSpaceSearch(machine, events, language=language, epoch=epoch, timezone=timezone)
    for expanded in search.expand(bound):
        progress(expanded, search.waiting)
    broken = tuple(property_findings(machine, search))
    states = (s for s in machine.states.values() if s.path and s.kind is not machines.StateKind.HISTORY)
    return Exploration(
        (*findings(machine, search, home), *broken),
        search.expanded,
        search.steps,
        search.waiting,
        tuple(s.path for s in states if s.name not in search.entered),
        tuple(t for s in machine.states.values() for t in s.transitions if t.where not in search.taken),
        tuple(p.name for p in machine.properties if p.where not in {finding.where for finding in broken}),
    )
