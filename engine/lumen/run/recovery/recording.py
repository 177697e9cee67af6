"""The journal of inputs of an exhibition that begins: where it is written, and which files it needs kept."""

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
from lumen.upkeep.private_folder import private_folder

REHEARSED = JournalRetention(keep=7.0, size=50.0)
"""How much is kept of what stories and programs played."""


def record_inputs(
    behavior: LiveBehavior, records: RunRecords, *, story: Story | None, rehearsed: bool
) -> JournalWriter:
    """Have it kept from now on what happens to a behaviour, by the writer that is returned.

    What visitors did is in the home of the run that has it. What a story or a program plays is `rehearsed`, and beside
    it: nobody's visit is pushed out by it. Where the project wants no journal, the last of it is in memory alone, and
    what there was is deleted.
    """
    files = _files(behavior.project, rehearsed=rehearsed) if rehearsed or records.keeper else None
    writer = JournalWriter(files, story=story.name if story else "", rehearsed=rehearsed)
    records.inputs = behavior.loop.runtime.recorder = writer
    writer.start()
    return writer


def _files(project: Project, *, rehearsed: bool) -> JournalFolder | None:
    """Where it is written, None where nothing is to be kept."""
    retention = wanted = project.section(JournalRetention)
    folder = home_of(Path(project.root), project.one_of_several) / JOURNAL_FOLDER
    if rehearsed:
        folder, retention = folder / REHEARSED_FOLDER, REHEARSED
    files = JournalFolder(folder, retention.keep, retention.size)
    if not wanted.wanted:
        files.clear()
        return None
    if rehearsed:
        _keep_files(project)
    return files


def _keep_files(project: Project) -> None:
    """Keep the files that run, where those that are there now are still the same."""
    root = Path(project.root)
    home = Home(home_of(root, project.one_of_several))
    try:
        files = read_files(root, project.one_of_several)
        private_folder(home.folder)
    except (OSError, LumenError):
        return  # then it can't be replayed; the run itself goes on
    if fingerprint(files) == project.hash:
        SnapshotStore(home).store(files)
