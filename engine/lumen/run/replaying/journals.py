"""The choice of a journal: a file, a day, all visits, or the last run; and the files that ran when it was written."""

from collections.abc import Iterable, Iterator
from dataclasses import replace
from datetime import date, datetime, time, timedelta
from pathlib import Path
from typing import NamedTuple

from lumen.errors import UsageError
from lumen.insight.replay.entries import RecordedEntry
from lumen.insight.replay.journal_clock import JournalClock
from lumen.journal.journal_file import JOURNAL_SUFFIX, JournalHeader, header_of, read_journal
from lumen.journal.journal_folder import JOURNAL_FOLDER, headers
from lumen.language.iso_time import time_of_day
from lumen.language.machines import MachineDefinition
from lumen.language.projects import Project
from lumen.lint import check_files
from lumen.project.chosen_robot import as_robot
from lumen.project.home import Home, home_of
from lumen.run.snapshot_store import SnapshotStore


class KeptBundles:
    """The bundles stored in the home of the project in `root`, each read on first use.

    `robot` is one of its `robots:`; empty if it has one `robot:`.
    """

    def __init__(self, root: Path, robot: str = "") -> None:
        self._root, self.robot, self._store = root, robot, SnapshotStore(Home(home_of(root, robot)))
        self._read: dict[str, Project | None] = {}

    def project(self, hash: str, behavior: str) -> Project | None:
        """Return the project of a hash, set to that behaviour.

        Return None if the bundle was not stored, lacks that behaviour, or can't be read by this version.
        """
        if hash not in self._read:
            self._read[hash] = self.load(hash)
        project = self._read[hash]
        if project is None or behavior not in project.behaviors:
            return None
        return project if project.behavior == behavior else replace(project, behavior=behavior)

    def load(self, hash: str) -> Project | None:
        """Read a project anew; None if it was not stored or can't be read."""
        files = self.files(hash)
        return check_files(self._root, files)[0] if files else None

    def files(self, hash: str) -> dict[str, bytes] | None:
        """Return the files of a bundle as this robot reads them; None if they were not stored."""
        files = self._store.files(hash)
        return as_robot(files, self.robot) if files else None

    def machine(self, hash: str, behavior: str) -> MachineDefinition | None:
        """Return the machine of the project of a hash, set to that behaviour; None if `project` returns None."""
        project = self.project(hash, behavior)
        return project.machine if project else None


DAYS = {"today": 0, "yesterday": 1}
"""Words for days, and how many days ago they are."""


class ChosenJournal(NamedTuple):
    """Files of one journal, in order."""

    root: Path
    """The folder of their project."""
    files: tuple[Path, ...]

    def entries(self) -> Iterator[RecordedEntry]:
        """Yield the entries of the files; of a truncated file those before the cut.

        Raises JournalError for an unreadable file.
        """
        for file in self.files:
            yield from read_journal(file).entries


def chosen(root: Path, word: str | None, *, all: bool = False, robot: str = "") -> ChosenJournal:
    """Return the journal in `root` that a word means: a file, `today`, `yesterday`, or a day such as `2026-11-23`.

    Without a word, return the journal of the last run, which may be a story; with `all`, that of every recorded visit.
    Raises UsageError if there is no such journal, JournalError if the file is unreadable.
    """
    folder = home_of(root, robot) / JOURNAL_FOLDER
    if word and (word.endswith(JOURNAL_SUFFIX) or "/" in word):
        file = Path(word)
        if not file.is_file():
            raise UsageError(f"no file {word}: `lumen replay --list` lists the files")
        header_of(file)
        return ChosenJournal(root, (file,))
    found = [(file, header) for file, header in headers(folder) if file.parent == folder or not (all or word)]
    if all:
        wanted = found
    elif word:
        day = _day(word)
        wanted = [(file, header) for file, header in found if datetime.fromtimestamp(header.began).date() == day]
    else:
        last = max(found, key=lambda row: row[1].began, default=None)
        wanted = [row for row in found if last and row[1].run == last[1].run]
    if not wanted:
        what = f" of {word}" if word else ""
        raise UsageError(
            f"there is no journal{what} in {folder}: `lumen run` writes one; `lumen replay --list` lists all"
        )
    return ChosenJournal(root, tuple(file for file, _ in wanted))


def listed(root: Path, robot: str = "") -> list[tuple[Path, JournalHeader]]:
    """Return the files of the project's journal with their headers, including those of stories, the oldest first."""
    return sorted(headers(home_of(root, robot) / JOURNAL_FOLDER), key=lambda row: row[1].began)


def until(entries: Iterable[RecordedEntry], text: str) -> Iterator[RecordedEntry]:
    """Yield the entries up to the first time of day `14:03` or `14:03:20` at the exhibition.

    Raises UsageError for other texts.
    """
    wanted, clock, limit = requested_time(text), JournalClock(), None
    for entry in entries:
        moment = clock.of(entry)
        if limit is None:
            limit = clock.next(moment, wanted)
        if moment > limit:
            return
        yield entry


def requested_time(text: str) -> time:
    """Return the time of day that a person wrote. Raises UsageError for any other text."""
    try:
        return time_of_day(text)
    except ValueError:
        raise UsageError(f"`{text}` is not a time of day: write it as 14:03 or 14:03:20") from None


def _day(word: str) -> date:
    if word in DAYS:
        return date.today() - timedelta(days=DAYS[word])
    try:
        return date.fromisoformat(word)
    except ValueError:
        raise UsageError(
            f"`{word}` is neither a file nor a day: write today, yesterday, or a date such as 2026-11-23"
        ) from None
