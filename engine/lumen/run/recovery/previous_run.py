"""The continuation of a previous run that ended unexpectedly; with newer files it is a reload."""

import time
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

from lumen.errors import LumenError, ProjectError
from lumen.insight.changes import changes
from lumen.insight.migration import Refusal
from lumen.language.projects import Project
from lumen.project.chosen_robot import as_robot
from lumen.project.crash_counter import MAX_CRASHES
from lumen.run.reload.records import RunRecords
from lumen.run.reload.report import START, ReloadReport
from lumen.run.reload.validation_worker import load_apart
from lumen.run.resuming import FreshStart, Resumption, resume
from lumen.run.snapshot_store import SNAPSHOT_VERSION, SnapshotStore, StoredSnapshot
from lumen.statechart import deserialize

LATELY = 600.0
"""The age of a snapshot up to which it is resumed [s]; after that the visitor has left."""

AT_REST = "The robot was at rest, and stays at rest until you hold its head or run `lumen resume`."

_UNKNOWN = Refusal("its files were not kept")


class Recovery(NamedTuple):
    """How a run continues or begins."""

    how: Resumption | FreshStart
    """The resumption, or the fresh start."""
    news: tuple[ReloadReport, ...] = ()
    """The report on the start as a reload; empty if the files are those of the previous run."""


def recover(root: Path, records: RunRecords, project: Project) -> Recovery:
    """Return how the run in these records continues under `project`, or why it begins anew.

    `root` is the project's folder.
    """
    keeper = records.keeper
    kept = keeper.kept() if keeper else None
    if keeper is None or kept is None:
        return Recovery(_after_another(keeper) if keeper else FreshStart())
    away, began = time.time() - kept.ended, time.perf_counter()
    if not 0.0 <= away <= LATELY:
        return _anew(kept, f"The last run {how_ended(kept)} {_ago(away)}: this one starts from the beginning.")
    if records.died(project.hash) >= MAX_CRASHES:
        return _anew(
            kept, "The last runs ended unexpectedly soon after their start: this one starts from the beginning."
        )
    try:
        old = _before(root, keeper, kept, project)
        how = _resumed(old, project, kept, away) if old else _UNKNOWN
    except LumenError as error:
        return _anew(kept, f"The last run {how_ended(kept)} and can't be continued: {error}")
    news = () if old is None or old.hash == project.hash else (_news(old, project, how, time.perf_counter() - began),)
    if isinstance(how, Refusal):
        why = f"The last run {how_ended(kept)}, and these files can't continue it: {how.reason}"
        return _anew(kept, why, news)
    return Recovery(how._replace(told=kept.told), news)


def how_ended(kept: StoredSnapshot) -> str:
    """Return how a run ended, `was ended` or `ended unexpectedly`, for a line to a person."""
    return "was ended" if kept.told else "ended unexpectedly"


def rested(records: RunRecords) -> FreshStart:
    """Return a beginning that ignores the previous run, except that a robot at rest stays at rest."""
    kept = records.keeper.kept() if records.keeper else None
    rests = kept.rests if kept else bool(records.keeper and records.keeper.of_another_version()[1])
    return FreshStart(AT_REST if rests else "", rests)


def _after_another(keeper: SnapshotStore) -> FreshStart:
    """Return how to begin if another version of Lumen may have written the snapshot."""
    version, rests = keeper.of_another_version()
    why = (
        f"The last run ended unexpectedly, under another version of Lumen (its snapshot has version {version}, "
        f"this one reads {SNAPSHOT_VERSION}): this run starts from the beginning. "
        "To continue such a run, start it with the same version of Lumen."
    )
    return FreshStart(f"{why}\n{AT_REST}" if rests else why, rests, crashed=True) if version else FreshStart()


def _anew(kept: StoredSnapshot, why: str, news: tuple[ReloadReport, ...] = ()) -> Recovery:
    told = f"{why}\n{AT_REST}" if kept.rests else why
    return Recovery(FreshStart(told, kept.rests, crashed=not kept.told), news)


def _resumed(old: Project, new: Project, kept: StoredSnapshot, away: float) -> Resumption | Refusal:
    snapshot = deserialize(old.machine, kept.frozen)
    return resume(old, new, snapshot, away, kept.tracking, kept.ended - kept.time)


def _before(root: Path, keeper: SnapshotStore, kept: StoredSnapshot, project: Project) -> Project | None:
    """Return the bundle that ran; None if it was not kept. Raises ProjectError if this version can't read it."""
    old: Project | None = project
    if kept.bundle != project.hash:
        files = keeper.files(kept.bundle)
        old, found = load_apart(root, as_robot(files, project.one_of_several)) if files else (None, ())
        if old is None and found:
            raise ProjectError(found)
    if old is None or kept.behavior not in old.behaviors:
        return None
    return old if kept.behavior == old.behavior else replace(old, behavior=kept.behavior)


def _news(old: Project, new: Project, how: Resumption | Refusal, took: float) -> ReloadReport:
    notes = (f"the behaviour starts from the beginning: {how.reason}",) if isinstance(how, Refusal) else how.notes
    found = changes(old, new)
    return ReloadReport("applied", START, old.hash, new.hash, changes=found, notes=notes, took={"loading": took})


def _ago(seconds: float) -> str:
    """Return an age in words: `12 s ago`, `5 min ago`, `3 h ago`."""
    if seconds < 0:
        return "in the future, by this machine's clock"
    for unit, name in ((3600.0, "h"), (60.0, "min")):
        if seconds >= 2 * unit:
            return f"{seconds / unit:.0f} {name} ago"
    return f"{seconds:.0f} s ago"
