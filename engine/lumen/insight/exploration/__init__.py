"""Explores a behaviour through everything that can happen, and tells where it would never get out again.

What counts as one configuration is said in `abstraction`, what can happen in `stimuli`, what events carry in `samples`.
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


@dataclass(frozen=True)
class Exploration:
    """What came of a search; `waiting` are configurations that its bound left out.

    `never_entered` and `never_taken` are states and transitions that it did not come upon: what it does not see, or
    what can't be. `kept` are the properties that hold wherever it came.
    """

    findings: tuple[ExplorationFinding, ...]
    configurations: int
    steps: int
    waiting: int
    never_entered: tuple[str, ...] = ()
    never_taken: tuple[Transition, ...] = ()
    kept: tuple[str, ...] = ()

    @property
    def complete(self) -> bool:
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
    """Explore every configuration that can be reached, up to `bound` of them.

    `events` are those that may come from outside, each with the JSON Schema of its data. `home` is the state to come
    back to; without it, each state of the beginning that has others beside it. What the bound left out may lead
    anywhere: nothing is found that depends on it. `progress` is called with how many configurations were explored and
    how many are in sight.
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
