"""All visits of a journal played with other files, to count those that would be the same."""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from time import monotonic

from lumen.errors import BadCommandError
from lumen.insight.changes import live
from lumen.insight.replay.against import SAME, VisitVerdict, played_against
from lumen.insight.replay.entries import JournalJump, RecordedEntry
from lumen.insight.replay.visits import RecordedVisit, visits
from lumen.language.commands import BodyCommand, Play
from lumen.language.machines import MachineDefinition
from lumen.language.projects import Project
from lumen.robot.command_table import COMMANDS, USUAL_DURATION, row_of
from lumen.run.replaying.journals import KeptBundles
from lumen.run.replaying.replay_report import ReplayReport

NOT_WHOLE = "visits that are incomplete in the journal"


def against(
    entries: Iterable[RecordedEntry],
    bundles: KeptBundles,
    new: Project,
    *,
    tell: Callable[[int], None] = lambda _: None,
    deadline: float | None = None,
) -> ReplayReport:
    """Return the result of playing each visit with the other files; `tell` is called with the number played so far.

    After `deadline` (`time.monotonic`) the remaining visits are not played, and count as unknown.
    """
    report, player = ReplayReport(), VisitPlayer(bundles, new)
    for visit in visits(with_machines(entries, bundles)):
        tell(report.visits + 1)
        if deadline is not None and monotonic() > deadline:
            report.visits += 1
            report.leave_out("visits for which there was no time")
        else:
            player.play(visit, report)
    return report


class VisitPlayer:
    """A player of visits with the files of `new`.

    If a visit was recorded under other files than the bundle `running`, a difference counts only if that bundle would
    not cause it as well. `hurry` may raise an error to end a visit.
    """

    def __init__(
        self,
        bundles: KeptBundles,
        new: Project,
        *,
        running: str = "",
        hurry: Callable[[], None] = lambda: None,
    ) -> None:
        self._bundles, self._new, self._running, self._hurry = bundles, new, running, hurry

    def play(self, visit: RecordedVisit, report: ReplayReport) -> None:
        """Play a visit and add its result to the report; an error from `hurry` leaves the report unchanged."""
        old = self._bundles.project(visit.home.bundle, visit.home.behavior) if visit.home else None
        known = old is not None and old.behavior in self._new.behaviors
        verdict = self._verdict(visit, old) if old and known and not visit.redacted else None
        report.visits += 1
        if visit.redacted:
            report.redacted += 1
        elif verdict:
            report.add(verdict, visit)
        elif old is None or known:
            report.leave_out(NOT_WHOLE)
        else:
            report.leave_out(f"visits of the behaviour `{old.behavior}`, which no longer exists")

    def _verdict(self, visit: RecordedVisit, old: Project) -> VisitVerdict | None:
        new = _staged_like(old, live(old, self._new))
        verdict = played_against(old, new, visit, takes, hurry=self._hurry)
        if verdict is None or verdict.how == SAME or not self._running or self._running == old.hash:
            return verdict
        running = self._bundles.project(self._running, old.behavior)
        if running is None:
            return verdict
        beside = _staged_like(old, live(old, running))
        return played_against(old, new, visit, takes, beside=beside, hurry=self._hurry)


def _staged_like(old: Project, new: Project) -> Project:
    """Return `new` with the behaviour that ran in `old`."""
    return new if new.behavior == old.behavior else replace(new, behavior=old.behavior)


def takes(project: Project, command: BodyCommand) -> float:
    """Return the time that the recording robot takes for a command [s]."""
    if isinstance(command, Play):
        motion = project.motions.get(command.motion)
        return motion.duration if motion else USUAL_DURATION
    if type(command) not in _KNOWN:
        return USUAL_DURATION
    try:
        return float(row_of(command).duration(command))  # type: ignore[arg-type]  # one of the table
    except BadCommandError:  # a row of a feature that gives no duration
        return USUAL_DURATION


_KNOWN = {row.command for row in COMMANDS}


def with_machines(
    entries: Iterable[RecordedEntry], bundles: KeptBundles
) -> Iterator[tuple[RecordedEntry, MachineDefinition | None]]:
    """Yield each entry with the machine that ran then; None if the machine's files were not stored."""
    machine: MachineDefinition | None = None
    for entry in entries:
        if isinstance(entry, JournalJump):
            machine = bundles.machine(entry.bundle, entry.behavior)
        yield entry, machine
