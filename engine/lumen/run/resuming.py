"""A behaviour that resumes after its engine was away, with a new clock and lost commands."""

from collections.abc import Iterable, Iterator
from typing import NamedTuple

from lumen.insight.migration import MigrationPlan, Refusal, plan
from lumen.language.commands import Cancel, Command
from lumen.language.events import Event
from lumen.language.projects import Project
from lumen.statechart import Snapshot, initial, paused, retimed
from lumen.statechart.command_ids import outer_id
from lumen.statechart.type_checks import fits, type_checks
from lumen.statechart.values import awaited

LOST_COMMAND_REASON = "the engine was restarted while the command was running"


class FreshStart(NamedTuple):
    """A run that does not continue the previous one."""

    why: str = ""
    """The reason; empty if there is nothing to report."""
    rests: bool = False
    """Whether the robot was at rest, and stays at rest until a person lets it move."""
    crashed: bool = False
    """Whether the previous run ended unexpectedly."""


class Resumption(NamedTuple):
    """The state from which a behaviour resumes."""

    snapshot: Snapshot
    """The snapshot to continue from."""
    away: float
    """The time for which the engine was away [s]."""
    commands: tuple[Command, ...] = ()
    """Commands to perform first."""
    lost: tuple[str, ...] = ()
    """The ids of the unfinished commands."""
    tracking: tuple[str, ...] = ()
    """The controllers that were on."""
    notes: tuple[str, ...] = ()
    """Sentences about values or states that were lost."""
    told: bool = False
    """Whether the operating system had ordered the previous run to end."""

    def answers(self, now: float) -> list[Event]:
        """Return an event `lost.command.ID` at `now` [s] for each unfinished command, which the robot has lost."""
        return [Event(f"lost.command.{id}", {"reason": LOST_COMMAND_REASON}, now) for id in self.lost]


def resume(
    old: Project, new: Project, snapshot: Snapshot, away: float, tracking: Iterable[str], unchanged: float = 0.0
) -> Resumption | Refusal:
    """Return how `new` continues from a snapshot of `old` at time 0 of a new clock, or why it can't.

    The engine was away for `away` [s], during which timers continued; before that, the snapshot had not changed for
    `unchanged` [s]. `tracking` are the controllers that were on. Newer files are applied like a reload that does not
    wait, because all actions under way have ended anyway.
    """
    later = retimed(paused(snapshot, away)._replace(at=snapshot.at + unchanged + away), 0.0, "remaining")
    verdict = MigrationPlan(later) if old is new else plan(old, new, later, now=True)
    if not isinstance(verdict, MigrationPlan):
        return verdict if isinstance(verdict, Refusal) else Refusal(verdict.reason)
    lost, known = tuple(_awaited(snapshot)), tuple(name for name in tracking if name in new.controllers)
    return Resumption(verdict.snapshot, away, verdict.entering, lost, known, verdict.notes)


def anew(project: Project, snapshot: Snapshot, now: float) -> MigrationPlan:
    """Return a plan for a project to begin anew at `now` [s]; context values of the snapshot stay if they still fit."""
    checks = type_checks(project.machine)
    kept = {key: value for key, value in snapshot.context.items() if key in checks and fits(value, checks[key])}
    language = snapshot.language if snapshot.language in project.languages else project.languages[0]
    first = initial(project.machine, now, kept, language, epoch=snapshot.epoch, timezone=snapshot.timezone)
    counted = first.snapshot._replace(generator=snapshot.generator)
    leaving = tuple(Cancel(id) for id in _awaited(snapshot))
    return MigrationPlan(
        counted, leaving, first.commands, entered=first.entered, notes=("the behaviour starts from the beginning",)
    )


def _awaited(snapshot: Snapshot) -> Iterator[str]:
    """Yield the ids of unfinished commands, as the robot receives them."""
    for position in snapshot.doing.values():
        yield from (id for id in awaited(position) if id.startswith("d"))
    for owner, child in snapshot.invoked.items():
        yield from (outer_id(id, owner) for id in _awaited(child.snapshot))
