"""The migration of a running behaviour to other files: a pure plan, a reason to wait, or a refusal.

`verdicts` has the three results. `placing` decides which states stay and which states follow the others. `situation`
decides whether a running `do` can continue. `carried_state` translates context, timers and history.
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
    """Return how a behaviour of `old` at that snapshot continues under `new` at `at` [s]; nothing is performed.

    Active states keep their identity by path or by `renamed`. A state that still exists is not entered again: its
    actions continue, and its timers count from when they were set, even if their delay has changed. A removed state
    runs its old exit actions, and the nearest `onReload` around it names the next state; without one, the result is a
    Refusal. If a running `do` was removed or changed, the result is a MigrationDelay; with `now`, the `do` is cancelled
    instead, and a changed `do` begins anew. If the content has not changed, the snapshot does not change either.

    `back` is a rollback: `new` ran before `old`, whose renamings are undone. Raises SnapshotError if `old` lacks an
    active state of the snapshot.
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
    """Return the verdict of `plan` for machines without a project, in which every language is allowed."""
    return migrated(old, new, snapshot, MigrationOptions(at, now, back), new.id)
