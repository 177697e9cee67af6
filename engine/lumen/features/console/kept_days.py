"""Days of an exhibition, from the journal of this machine or from entries that the exhibition sends."""

from collections.abc import Iterable, Iterator, Mapping
from contextlib import suppress
from datetime import date, datetime
from pathlib import Path
from typing import Any

from lumen.errors import JournalError
from lumen.features.console.day import Day, day_of
from lumen.insight.replay.entries import RecordedEntry, entry_data, read_entry
from lumen.insight.replay.journal_clock import JournalClock
from lumen.journal.journal_file import each_entry
from lumen.journal.journal_folder import JOURNAL_FOLDER, headers
from lumen.language.machines import MachineDefinition
from lumen.language.projects import Project
from lumen.lint import check_files
from lumen.project.building import knowledge_parts, sayings_parts
from lumen.project.files import read_files
from lumen.project.home import home_of
from lumen.retrieval.scorers import words
from lumen.run.one_robot import one_robot
from lumen.run.replaying.journals import KeptBundles

WINDOW = 86_400.0 * 2
"""A journal file can contain entries of a day only if it began within this time before the day's end [s]."""


class KeptDays:
    """Days of a robot of the project in `root`: the one named `robot`, or the first if that is empty."""

    def __init__(self, root: Path, robot: str = "") -> None:
        self._robot = one_robot(root, robot)
        self._root, self._kept = root, KeptBundles(root, self._robot)
        self._here = list[Project | None]()

    def day(self, wanted: date | None) -> Day | None:
        """Return the `wanted` day from this machine's files, by default the last; None if there are no files."""
        files = sorted(self._files(), key=lambda row: row[1])
        if not files:
            return None
        clock = JournalClock()
        if first := next(_entries([file for file, _, _ in reversed(files)]), None):
            clock.of(first)  # it has the exhibition's time zone, which may differ from this machine's
        dates = sorted({clock.local(began).date() for _, _, began in files})
        chosen = wanted or dates[-1]
        end = datetime.combine(chosen, datetime.max.time(), clock.local(0.0).tzinfo).timestamp()
        wanted_files = [file for file, _, began in files if end - WINDOW <= began <= end]
        found = day_of(_entries(wanted_files), self._machine, chosen)
        found.dates = sorted({*dates, *found.dates})
        return self._still_open(found)

    def entries(self, first: int, last: int, most: int) -> dict[str, Any]:
        """Return at most `most` entries between two positions, as the fields of a `ToldPage`."""
        files, clock = sorted(self._files(), key=lambda row: row[1]), JournalClock()
        begin = max((number for number, row in enumerate(files) if row[1] <= first), default=0)
        found, epoch = list[dict[str, Any]](), None
        for entry in _entries([file for file, _, _ in files[begin:]]):
            if entry.position > last or len(found) >= most:
                break
            if entry.position >= first:
                epoch = clock.epoch if not found else epoch
                found.append({"position": entry.position, **entry_data(entry)})
            clock.of(entry)
        return {"entries": found, "epoch": epoch or None}

    def told(self, pages: Iterable[Any], wanted: date | None) -> Day:
        """Return the `wanted` day, by default the last, from pages of entries as an exhibition sends them."""
        return self._still_open(day_of((entry for page in pages for entry in _recorded(page)), self._machine, wanted))

    def _still_open(self, found: Day) -> Day:
        """Return the day without questions that a passage now answers, and without sentences that are now sayings."""
        if found.unanswered:
            known = knowledge_parts(read_files(self._root, self._robot)).knowledge.values()
            answered = {
                (language, *words(text))
                for passage in known
                for language, texts in passage.questions.items()
                for text in texts
            }
            for text, language in [*found.unanswered]:
                if (language, *words(text)) in answered:
                    del found.unanswered[text, language]
        if found.said:
            sayings = sayings_parts(read_files(self._root, self._robot)).sayings.values()
            kept = {(one.behavior, one.state, *words(one.text)) for each in sayings for one in each.sayings}
            for sentence in [*found.said]:
                if any((*state, *words(sentence.text)) in kept for state in sentence.states):
                    del found.said[sentence]
        return found

    def _machine(self, hash: str, behavior: str) -> MachineDefinition | None:
        """Return the behaviour from its bundle, else from the saved files; None if these have errors or lack it."""
        if kept := self._kept.machine(hash, behavior):
            return kept
        if not self._here:
            self._here = [check_files(self._root, read_files(self._root, self._robot))[0]]
        project = self._here[0]
        return project.behaviors.get(behavior) if project else None

    def _files(self) -> Iterator[tuple[Path, int, float]]:
        folder = home_of(self._root, self._robot) / JOURNAL_FOLDER
        for file, header in headers(folder) if folder.is_dir() else ():
            if file.parent == folder:
                yield file, header.first, header.began


def _entries(files: list[Path]) -> Iterator[RecordedEntry]:
    for file in files:
        with suppress(JournalError):
            yield from each_entry(file)


def _recorded(page: Iterable[Mapping[str, Any]]) -> Iterator[RecordedEntry]:
    for one in page:
        with suppress(JournalError):
            yield read_entry(one, int(one["position"]))
