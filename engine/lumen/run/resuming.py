"""A behaviour that goes on after its engine was away: time on another clock, and what became of commands."""

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
    """A run that does not go on with the one before, and why, where there is something to say.

    `rests` is whether the robot was at rest then: nobody but a person lets it move. `crashed` is whether the one before
    ended without notice.
    """

    why: str = ""
    rests: bool = False
    crashed: bool = False


class Resumption(NamedTuple):
    """How a behaviour goes on: from `snapshot`, with what has to be performed first.

    `lost` are the commands that were under way, `tracking` the controllers that were on, `away` [s] how long the engine
    was, and `told` whether it had been told to end. `notes` say what somebody could miss.
    """

    snapshot: Snapshot
    away: float
    commands: tuple[Command, ...] = ()
    lost: tuple[str, ...] = ()
    tracking: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()
    told: bool = False

    def answers(self, now: float) -> list[Event]:
        """An answer for each command that was under way: the robot has forgotten it."""
        return [Event(f"lost.command.{id}", {"reason": LOST_COMMAND_REASON}, now) for id in self.lost]


def resume(
    old: Project, new: Project, snapshot: Snapshot, away: float, tracking: Iterable[str], unchanged: float = 0.0
) -> Resumption | Refusal:
    """How `new` goes on at time 0 of a new clock from a snapshot of `old`, whose timers went on while it was away [s].

    Before it ended it had stood `unchanged` [s] where the snapshot says.
    Newer files are a reload that waits for nothing: what was under way has ended anyway.
    """
    later = retimed(paused(snapshot, away)._replace(at=snapshot.at + unchanged + away), 0.0, "remaining")
    verdict = MigrationPlan(later) if old is new else plan(old, new, later, now=True)
    if not isinstance(verdict, MigrationPlan):
        return verdict if isinstance(verdict, Refusal) else Refusal(verdict.reason)
    lost, known = tuple(_awaited(snapshot)), tuple(name for name in tracking if name in new.controllers)
    return Resumption(verdict.snapshot, away, verdict.entering, lost, known, verdict.notes)


def anew(project: Project, snapshot: Snapshot, now: float) -> MigrationPlan:
    """How a project that can't go on from a snapshot begins anew at `now` [s]: with all that fits of its context."""
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
    """The ids of commands, not of waits, as they are called outside."""
    for position in snapshot.doing.values():
        yield from (id for id in awaited(position) if id.startswith("d"))
    for owner, child in snapshot.invoked.items():
        yield from (outer_id(id, owner) for id in _awaited(child.snapshot))
