"""All visits of a journal against other files: how many would have been the same?"""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from time import monotonic

from lumen.app.replaying.kept_bundles import KeptBundles
from lumen.app.replaying.replay_report import ReplayDifference, ReplayReport
from lumen.interpreters.changes import live
from lumen.interpreters.replay.against import SAME, played_against
from lumen.interpreters.replay.entries import JournalJump, RecordedEntry
from lumen.interpreters.replay.visits import RecordedVisit, visits
from lumen.language.commands import BodyCommand, Play
from lumen.language.machines import MachineDefinition
from lumen.language.projects import Project
from lumen.robots.command_table import COMMANDS, USUAL_DURATION, row_of

NOT_WHOLE = "visits that are not whole in the journal"


def against(
    entries: Iterable[RecordedEntry],
    bundles: KeptBundles,
    new: Project,
    *,
    tell: Callable[[int], None] = lambda _: None,
    deadline: float | None = None,
) -> ReplayReport:
    """What comes of playing each visit with the other files; `tell` hears how many were played.

    Where a `deadline` (`time.monotonic`) passes the rest is left out, and said to be unknown.
    """
    report = ReplayReport()
    for visit in visits(_with_machines(entries, bundles)):
        report.visits += 1
        tell(report.visits)
        if deadline is not None and monotonic() > deadline:
            _unknown(report, "there was no time for them")
        elif visit.redacted:
            report.redacted += 1
        else:
            _play(report, visit, bundles, new)
    return report


def _play(report: ReplayReport, visit: RecordedVisit, bundles: KeptBundles, new: Project) -> None:
    old = bundles.project(visit.home.bundle, visit.home.behavior) if visit.home else None
    if old is None or old.behavior not in new.behaviors:
        _unknown(report, NOT_WHOLE if old is None else f"there is no behaviour `{old.behavior}` any more")
        return
    verdict = played_against(old, _staged_like(old, live(old, new)), visit, takes)
    if verdict is None:
        _unknown(report, NOT_WHOLE)
        return
    report.steps += verdict.steps
    if verdict.how == SAME:
        report.same += 1
    else:
        at = visit.ended + verdict.at - visit.inputs[-1].event.at
        report.differ.append(ReplayDifference(report.visits, at, verdict.was, verdict.now, verdict.how))


def _staged_like(old: Project, new: Project) -> Project:
    """The other files with the behaviour that ran then."""
    return new if new.behavior == old.behavior else replace(new, behavior=old.behavior)


def takes(project: Project, command: BodyCommand) -> float:
    """How long the recording robot takes for a command [s]."""
    if isinstance(command, Play):
        motion = project.motions.get(command.motion)
        return motion.duration if motion else USUAL_DURATION
    if type(command) not in _KNOWN:
        return USUAL_DURATION
    return float(row_of(command).duration(command))  # type: ignore[arg-type]  # one of the table


_KNOWN = {row.command for row in COMMANDS}


def _unknown(report: ReplayReport, why: str) -> None:
    report.unknown[why] = report.unknown.get(why, 0) + 1


def _with_machines(
    entries: Iterable[RecordedEntry], bundles: KeptBundles
) -> Iterator[tuple[RecordedEntry, MachineDefinition | None]]:
    machine: MachineDefinition | None = None
    for entry in entries:
        if isinstance(entry, JournalJump):
            machine = bundles.machine(entry.bundle, entry.behavior)
        yield entry, machine
