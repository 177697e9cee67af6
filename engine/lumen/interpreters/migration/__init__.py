"""Lets a running behaviour go on under other files: a pure plan, a reason to wait, or a reason why not.

`Plan`, `Wait` and `Refusal` are in `verdicts`; which state is which, in `identity`; what stays and where the rest goes,
in `placing`; what a `do` under way has to do with it, in `doing`; context, timers and history, in `carrying`.
"""

from lumen.interpreters.migration.migrating import MigrationOptions, move
from lumen.interpreters.migration.verdicts import MigrationDelay, MigrationPlan, MigrationVerdict, Refusal
from lumen.interpreters.statechart import Snapshot
from lumen.language.machines import MachineDefinition
from lumen.language.projects import Project

__all__ = ["MigrationDelay", "MigrationPlan", "MigrationVerdict", "Refusal", "migrate", "plan"]


def plan(
    old: Project, new: Project, snapshot: Snapshot, *, at: float = 0.0, now: bool = False, back: bool = False
) -> MigrationVerdict:
    """How the behaviour that runs by `old` goes on by `new` from that snapshot at `at` [s]; nothing happens.

    Active states keep their identity by path or by `renamed`. One that is still there is not entered again, keeps its
    timers' deadlines and what it does; one that is gone runs its old exit actions, and the nearest `onReload` around
    says where to go (else a Refusal). Where a `do` under way is gone or changed that is a Wait, or with `now` cancelled
    (a changed one begins anew). The same content gives the same snapshot.

    `back` is a rollback: `new` ran before `old`, whose renamings are undone.
    """
    how = MigrationOptions(at, now, back, new.languages)
    return move(old.machine, new.machine, snapshot, how, new.behavior)


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
    return move(old, new, snapshot, MigrationOptions(at, now, back), new.id)
