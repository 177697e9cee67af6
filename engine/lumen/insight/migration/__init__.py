"""Lets a running behaviour go on under other files: a pure plan, a reason to wait, or a reason why not.

The answers are in `verdicts`; which state is which, in `identity`; what stays and where the rest goes, in `placing`;
whether a `do` under way can go on, in `activity_compatibility`; context, timers and history, in `carried_state`.
"""

from lumen.insight.migration.migrating import migrated
from lumen.insight.migration.situation import MigrationOptions
from lumen.insight.migration.verdicts import MigrationDelay, MigrationPlan, MigrationVerdict, Refusal
from lumen.language.machines import MachineDefinition
from lumen.language.projects import Project
from lumen.statechart import Snapshot

__all__ = ["MigrationDelay", "MigrationPlan", "MigrationVerdict", "Refusal", "migrate", "plan"]


def plan(
    old: Project, new: Project, snapshot: Snapshot, *, at: float = 0.0, now: bool = False, back: bool = False
) -> MigrationVerdict:
    """How the behaviour that runs by `old` goes on by `new` from that snapshot at `at` [s]; nothing happens.

    Active states keep their identity by path or by `renamed`. One that is still there is not entered again, keeps its
    timers' deadlines and what it does; one that is gone runs its old exit actions, and the nearest `onReload` around
    says where to go (else a Refusal). Where a `do` under way is gone or changed that is a MigrationDelay; with `now`
    it is cancelled (a changed one begins anew). The same content gives the same snapshot.

    `back` is a rollback: `new` ran before `old`, whose renamings are undone.
    """
    options = MigrationOptions(at, now, back, new.languages)
    return migrated(old.machine, new.machine, snapshot, options, new.behavior)


def migrate(
    old: MachineDefinition,
    new: MachineDefinition,
    snapshot: Snapshot,
    *,
    at: float = 0.0,
    now: bool = False,
    back: bool = False,
) -> MigrationVerdict:
    """The plan for machines without a project around them."""
    return migrated(old, new, snapshot, MigrationOptions(at, now, back), new.id)
