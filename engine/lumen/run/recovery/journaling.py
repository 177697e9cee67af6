"""The journal of inputs of an exhibition that begins: its folder, and the files that it needs."""

from pathlib import Path

from lumen.errors import LumenError
from lumen.journal.journal_folder import JOURNAL_FOLDER, REHEARSED_FOLDER, JournalFolder
from lumen.journal.journal_writer import JournalWriter
from lumen.language.projects import Project
from lumen.language.retention import JournalRetention
from lumen.language.stories import Story
from lumen.project.files import fingerprint, read_files
from lumen.project.home import Home, home_of
from lumen.run.live_behavior import LiveBehavior
from lumen.run.reload.records import RunRecords
from lumen.run.snapshot_store import SnapshotStore
from lumen.upkeep.own_folders import private_folder

REHEARSED = JournalRetention(keep=7.0, size=50.0)
"""The limits for recorded runs by stories and programs."""


def record_inputs(
    behavior: LiveBehavior, records: RunRecords, *, story: Story | None, rehearsed: bool
) -> JournalWriter:
    """Record a behaviour's inputs from now on; return the writer of the journal.

    The journal of visits is in the home, if this run holds it. Runs by a story or a program are `rehearsed`, and in a
    separate folder, so that they do not replace visits. If the project wants no journal, only the last part is kept, in
    memory, and the existing files are deleted.
    """
    files = _files(behavior.project, records, rehearsed=rehearsed) if rehearsed or records.keeper else None
    writer = JournalWriter(files, story=story.name if story else "", rehearsed=rehearsed)
    records.inputs = behavior.loop.runtime.recorder = writer
    writer.start()
    return writer


def _files(project: Project, records: RunRecords, *, rehearsed: bool) -> JournalFolder | None:
    """Return the folder of the journal; None if no journal is written."""
    retention = wanted = project.section(JournalRetention)
    folder = home_of(Path(project.root), project.one_of_several) / JOURNAL_FOLDER
    if rehearsed:
        folder, retention = folder / REHEARSED_FOLDER, REHEARSED
    files = JournalFolder(folder, retention.keep, retention.size)
    if not wanted.wanted:
        files.clear()
        return None
    if rehearsed and not (records.keeper and records.keeper.has(project.hash)):
        _keep_files(project)
    return files


def _keep_files(project: Project) -> None:
    """Store the files of the bundle for replays, if those on disk are still the same."""
    root = Path(project.root)
    home = Home(home_of(root, project.one_of_several))
    try:
        files = read_files(root, project.one_of_several)
        private_folder(home.folder)
    except (OSError, LumenError):
        return  # without the files the run can't be replayed, but it continues
    if fingerprint(files) == project.hash:
        SnapshotStore(home).store(files)
