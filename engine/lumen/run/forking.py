"""`{"ask": "fork"}`: the course of the behaviour from a moment on, with another event or with the saved files."""

from collections.abc import Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from time import monotonic
from typing import Any

from lumen.errors import JournalError, LumenError, ProjectError, UsageError
from lumen.insight.changes import live
from lumen.insight.replay.entries import JournalJump, RecordedEntry
from lumen.insight.replay.forking import fork
from lumen.insight.replay.journal_clock import JournalClock
from lumen.journal.journal_file import entry_of, read_journal
from lumen.journal.journal_folder import headers
from lumen.journal.journal_writer import JournalWriter
from lumen.language.events import Event
from lumen.language.projects import Project
from lumen.lint import check_files
from lumen.project.files import read_files
from lumen.run.answering import moment_of
from lumen.run.replaying.journals import KeptBundles
from lumen.run.replaying.other_files import takes

PATIENCE = 3.0
"""The longest time to make an answer [s]."""
MAX_NAME = 100
"""The greatest length of an event's name [characters]."""


def forked(journal: JournalWriter, running: Project, body: Mapping[str, Any]) -> dict[str, Any]:
    """Return the answer: the lists of journal entries `was` and `would`, or a refusal with its reason."""
    try:
        return _forked(journal, running, body)
    except LumenError as error:
        return {"verdict": "refused", "reason": str(error)}


def _forked(journal: JournalWriter, running: Project, body: Mapping[str, Any]) -> dict[str, Any]:
    deadline, kept = monotonic() + PATIENCE, KeptBundles(Path(running.root), running.one_of_several)

    def hurry() -> None:
        if monotonic() > deadline:
            raise LumenError(f"it would take longer than {PATIENCE:g} s")

    def bundle(hash: str, behavior: str) -> Project | None:
        return running if (hash, behavior) == (running.hash, running.behavior) else kept.project(hash, behavior)

    journal.flush(PATIENCE / 2)
    event, saved = _event(body.get("event")), _saved(running) if body.get("bundle") == "saved" else None
    entries, position = _entries(journal, body)
    found = fork(entries, position, bundle, takes, event=event, saved=saved, hurry=hurry)
    said = {"trouble": found.trouble} if found.trouble else {}
    return {"was": list(found.was), "would": list(found.would), **said}


def _event(said: Any) -> Event | None:
    match said:
        case None:
            return None
        case {"name": str(name), **more} if name and len(name) <= MAX_NAME:
            return Event(name, more.get("data"))
    raise UsageError('`event` must look like `{"name": "heard", "data": {…}}`')


def _saved(running: Project) -> Project:
    """Return the project as it is saved, with the running values of settings that can't change during a run.

    Raises ProjectError if the saved files have errors.
    """
    root = Path(running.root)
    project, diagnostics = check_files(root, read_files(root))
    if project is None:
        raise ProjectError(diagnostics)
    return live(running, project)


def _entries(journal: JournalWriter, body: Mapping[str, Any]) -> tuple[Sequence[RecordedEntry], int]:
    """Return the entries around the fork, and the position of the first entry that may differ.

    Raises UsageError if the request has no valid `position` or `at`, or the journal lacks that time.
    """
    position, at = body.get("position"), body.get("at")
    if type(position) is not int and not isinstance(at, str):
        raise UsageError("add `position`, the position of an entry, or `at`, a time such as 2026-11-22T14:03:00Z")
    remembered = _remembered(journal)
    if type(position) is int:
        return (remembered if _knows(remembered, position) else _kept(journal, position)), position
    moment = moment_of(str(at))
    found = _after(remembered, moment, journal.tail.epoch)
    if found is not None and _knows(remembered, found):
        return remembered, found
    for file, header in sorted(_files(journal), key=lambda row: row[1].first, reverse=True):
        if header.began <= moment and (found := _after(entries := _read(file), moment)) is not None:
            return entries, found
    raise UsageError("the journal has nothing from that time")


def _remembered(journal: JournalWriter) -> list[RecordedEntry]:
    found: list[RecordedEntry] = []
    for position, line in journal.tail.since(journal.tail.first, journal.tail.next - journal.tail.first):
        with suppress(JournalError):
            found.append(entry_of(line, position))
    return found


def _knows(entries: Sequence[RecordedEntry], position: int) -> bool:
    """Return whether the entries have a snapshot at or before `position`, from which a replay can begin."""
    return any(
        isinstance(one, JournalJump) and one.snapshot is not None and one.position <= position for one in entries
    )


def _kept(journal: JournalWriter, position: int) -> Sequence[RecordedEntry]:
    """Return the entries of the file that contains `position`. Raises UsageError if no file does."""
    files = sorted((header.first, file) for file, header in _files(journal) if header.first <= position)
    if not files:
        raise UsageError(f"entry {position} is no longer in the journal")
    return _read(files[-1][1])


def _files(journal: JournalWriter) -> list[Any]:
    folder = journal.folder.folder if journal.folder else None
    return [row for row in headers(folder) if row[0].parent == folder] if folder else []


def _read(file: Path) -> Sequence[RecordedEntry]:
    return list(read_journal(file).entries)


def _after(entries: Sequence[RecordedEntry], moment: float, epoch: float | None = None) -> int | None:
    """Return the position of the first entry at or after a moment [s since 1970], else None.

    `epoch` is the date of time 0 before the entries, None if one of the first entries has it.
    """
    clock = JournalClock(epoch)
    return next((entry.position for entry in entries if clock.of(entry) >= moment), None)
