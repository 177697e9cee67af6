"""Steps of an ended run, or older ones than a running exhibition remembers: replayed from the journal."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

from lumen.errors import JournalError, UsageError
from lumen.insight.explaining import RecordedStep
from lumen.insight.replay.entries import JournalJump, RecordedEntry
from lumen.insight.replay.replaying import Replayer
from lumen.journal.journal_file import read_journal
from lumen.journal.journal_folder import JOURNAL_FOLDER, headers
from lumen.language.iso_time import time_of
from lumen.language.operator_requests import WHY, WHY_NOT
from lumen.language.projects import Project
from lumen.project.home import home_of
from lumen.project.running_project import running_project
from lumen.run.answering import answer
from lumen.run.one_robot import one_robot
from lumen.run.replaying.journals import KeptBundles
from lumen.statechart import Snapshot, Step

NOT_ASKED = "no running exhibition was asked"
MAX_FILES = 8
"""The number of a run's files, up to the requested moment, that are read; each covers some hours."""


def answer_from_journal(
    project: str | None, question: str, what: str, at: str | None, why: str, robot: str = ""
) -> dict[str, Any]:
    """Return an answer from the last run that began before `at` (ISO 8601; None for now).

    `question`, `what` and `at` are those of `answering.answer`. `why` is the reason why no running exhibition was
    asked. Raises UsageError, with that reason or advice, if the journal has no answer; ValueError if `at` is no time.
    """
    root = running_project(project)
    robot = one_robot(root, robot)
    steps = list(recalled(root, time_of(at) if at else None, robot))
    if not steps:
        raise UsageError(f"{why}; its journal in {home_of(root, robot) / JOURNAL_FOLDER} has nothing from that time")
    return answer(steps, question, what, at)


def why(what: str = "", path: str | None = None, at: str | None = None) -> dict[str, Any]:
    """Return why something happened in the last run of a project, as `lumen why --format json` prints it.

    `path` is the project's folder, by default the one here or above; `at` is an ISO 8601 time: only what happened until
    then counts. Raises UsageError, with advice, if it did not happen or there is no journal; ValueError if `at` is no
    such time.
    """
    return answer_from_journal(path, WHY.ask, what, at, NOT_ASKED)


def why_not(what: str, path: str | None = None, at: str | None = None) -> dict[str, Any]:
    """Return why something did not happen in the last run of a project. Arguments and errors are those of `why`."""
    return answer_from_journal(path, WHY_NOT.ask, what, at, NOT_ASKED)


def recalled(root: Path, until: float | None = None, robot: str = "") -> Iterator[RecordedStep]:
    """Yield the recorded steps of the project's last run that began before `until` [s since 1970, in UTC].

    A story runs on a date of its own, so one is used only without `until`, or if no visit began before it.
    """
    found = sorted(headers(home_of(root, robot) / JOURNAL_FOLDER), key=lambda row: row[1].began)
    visits = [row for row in found if until is not None and not row[1].story and row[1].began <= until]
    played = [row for row in found[-1:] if until is None or row[1].story]
    chosen = visits or (played and found)
    run = chosen[-1][1].run if chosen else ""
    files = sorted((row for row in chosen if row[1].run == run), key=lambda row: row[1].first)
    kept = KeptBundles(root, robot)
    replayer, standing = Replayer(kept.machine), _Standing(kept)
    for file, _ in files[-MAX_FILES:]:
        try:
            entries = read_journal(file).entries
        except JournalError:
            continue
        for entry in entries:
            yield from standing.after(entry, replayer.take(entry))


class _Standing:
    """A converter of replayed entries to recorded steps: a jump becomes a reload, and a keyframe becomes nothing."""

    def __init__(self, kept: KeptBundles) -> None:
        self._kept = kept
        self._project: Project | None = None
        self._snapshot: Snapshot | None = None

    def after(self, entry: RecordedEntry, taken: Any) -> Iterator[RecordedStep]:
        if isinstance(entry, JournalJump):
            self._project = self._kept.project(entry.bundle, entry.behavior)
        if taken.step is not None:
            yield RecordedStep(taken.machine, taken.before, taken.step, self._project)
        elif isinstance(entry, JournalJump) and taken.machine and taken.before and entry.kind != "keyframe":
            before = self._snapshot or taken.before
            gone, come = before.configuration, taken.before.configuration
            jump = Step(None, tuple(sorted(gone - come)), tuple(sorted(come - gone)), (), taken.before)
            yield RecordedStep(taken.machine, before, jump, self._project)
        self._snapshot = taken.after
