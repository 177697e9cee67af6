"""A recording's metadata, and the attached files that explain it."""

import platform
import time
from collections.abc import Iterator, Sequence
from contextlib import suppress
from pathlib import Path

from lumen.errors import LumenError
from lumen.features.mcap.files.foxglove import NANO
from lumen.features.mcap.files.recorded import RecordedFile, RecordedNotes
from lumen.journal.journal_file import JOURNAL_SUFFIX
from lumen.journal.journal_folder import JOURNAL_FOLDER, headers
from lumen.language.iso_time import iso_time
from lumen.language.projects import Project
from lumen.project.files import fingerprint, read_files
from lumen.project.home import Home, home_of
from lumen.run.bundles import packed
from lumen.run.snapshot_store import SnapshotStore

NOTES = "lumen"
"""The name of the metadata about the running files, which is added again after each reload."""


def notes_of(project: Project) -> RecordedNotes:
    """Return the metadata about the exhibition, its robot and its files, valid from now on."""
    from importlib.metadata import version  # imports the email package, which only recordings need

    said = {
        "exhibition": project.name,
        "robot": project.robot,
        "body": project.body.name,
        "bundle": project.hash,
        "behavior": project.behavior,
        "lumen": version("lumen-robot"),
        "python": platform.python_version(),
        "from": iso_time(time.time(), offset=True),
    }
    return RecordedNotes(NOTES, tuple(said.items()))


def bundle_files(root: Path, hashes: Sequence[str], robot: str = "") -> Iterator[RecordedFile]:
    """Yield a ZIP with the files of each bundle; skip bundles neither stored nor in the project's folder."""
    store = SnapshotStore(Home(home_of(root, robot)))
    for hash in dict.fromkeys(hashes):
        files = store.files(hash)
        if files is None:
            with suppress(OSError, LumenError):
                there = read_files(root)
                files = there if fingerprint(there) == hash else None
        if files is not None:
            yield RecordedFile(f"bundle-{hash[:16]}.zip", "application/zip", packed(files), int(time.time() * NANO))


def journal_files(root: Path, began: float, ended: float, robot: str = "") -> Iterator[RecordedFile]:
    """Yield the journal files that cover any time from `began` to `ended` [s since 1970]; skip unreadable files."""
    for file, header in headers(home_of(root, robot) / JOURNAL_FOLDER):
        with suppress(OSError):
            changed = file.stat().st_mtime
            if header.began <= ended and changed >= began:
                yield RecordedFile(
                    f"journal/{file.name}",
                    f"application/x-lumen{JOURNAL_SUFFIX}",
                    file.read_bytes(),
                    int(changed * NANO),
                )
