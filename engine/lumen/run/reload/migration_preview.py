"""A preview of a reload from every configuration that a behaviour can reach."""

from collections.abc import Callable
from dataclasses import dataclass, replace

from lumen.insight.exploration.search import StateSpaceSearch, leaves
from lumen.insight.migration import MigrationDelay, MigrationPlan, MigrationVerdict, plan
from lumen.language.projects import Project
from lumen.run.exploring import outside
from lumen.run.story_time import story_epoch
from lumen.statechart import Snapshot


@dataclass(frozen=True)
class MigrationOutcome:
    """The outcome of a reload in some innermost states."""

    states: tuple[str, ...]
    """The innermost active states before the reload."""
    outcome: str
    """`kept`, `moved`, `waits` or `refused`."""
    told: str
    """Notes, or the reason why it waits or is refused."""
    after: tuple[str, ...]
    """The innermost active states afterwards."""
    verdict: MigrationVerdict
    """The plan, delay or refusal itself."""
    count: int = 1
    """Number of configurations with this outcome."""


@dataclass(frozen=True)
class MigrationPreview:
    """The outcomes in all explored configurations; `waiting` counts those beyond the bound."""

    rows: tuple[MigrationOutcome, ...]
    configurations: int
    waiting: int


def preview(old: Project, new: Project, bound: int, tell: Callable[[int, int], None]) -> MigrationPreview:
    """Return the outcome in every reachable configuration of the old behaviour, with equal outcomes counted together.

    `bound` limits the exploration; `tell` is called with how many configurations were explored, and how many wait.
    """
    machine = old.machine
    language, epoch = old.languages[0], story_epoch(None, old.timezone)
    search = StateSpaceSearch(machine, outside(old, machine), language=language, epoch=epoch, timezone=old.timezone)
    for explored in search.expand(bound):
        tell(explored, search.waiting)
    found: dict[tuple[object, ...], MigrationOutcome] = {}
    for node in search.nodes.values():
        fate = outcome_of(old, new, node.snapshot)
        key = (fate.states, fate.outcome, fate.told, fate.after)
        found[key] = replace(fate, count=found[key].count + 1 if key in found else 1)
    order = ("refused", "waits", "moved", "kept")
    rows = sorted(found.values(), key=lambda fate: order.index(fate.outcome))
    return MigrationPreview(tuple(rows), len(search.nodes), search.waiting)


def outcome_of(old: Project, new: Project, snapshot: Snapshot) -> MigrationOutcome:
    """Return what a reload at this moment would do."""
    verdict = plan(old, new, snapshot, at=snapshot.at)
    before = _inner(old, snapshot)
    if isinstance(verdict, MigrationPlan):
        after = _inner(new, verdict.snapshot)
        outcome = "moved" if verdict.exited or verdict.entered else "kept"
        return MigrationOutcome(before, outcome, "; ".join(verdict.notes), after, verdict)
    if isinstance(verdict, MigrationDelay):
        return MigrationOutcome(before, "waits", verdict.reason, (), verdict)
    return MigrationOutcome(before, "refused", verdict.reason, (), verdict)


def _inner(project: Project, snapshot: Snapshot) -> tuple[str, ...]:
    machine = project.machine
    return tuple(machine.states[path].name for path in leaves(machine, snapshot.configuration))
