"""A version of a project: a folder, a revision of its repository, or the running files."""

import os
from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

from lumen.errors import ProjectError, UsageError
from lumen.language.projects import Project
from lumen.lint import check_files
from lumen.project.chosen_robot import as_robot
from lumen.project.files import read_files
from lumen.project.home import Home, home_of
from lumen.project.revisions import files_at
from lumen.project.running_project import own_project
from lumen.run.one_robot import one_robot
from lumen.run.snapshot_store import SnapshotStore, StoredSnapshot
from lumen.statechart import Snapshot, deserialize

LIVE = "live"


class Version(NamedTuple):
    """A project in one version."""

    name: str
    """The name that was given; the project's folder if none was."""
    project: Project
    files: Mapping[str, bytes]
    """The contents of its files, by path."""
    snapshot: Snapshot | None = None
    """The current snapshot if this version is running now; else None."""


def version(name: str | None, here: Path | None = None, robot: str = "") -> Version:
    """Return a version by name: `live`, a folder, or a revision of the project `here` (default: this one, or above).

    Without a name it is that project's present files. Of several robots, the version is that of `robot`, by default the
    first. Raises UsageError if there is no such version, or its files have errors.
    """
    folder = name is not None and name != LIVE and os.path.exists(name)
    root = own_project(name) if folder else here or own_project()
    robot = one_robot(root, robot)
    kept: StoredSnapshot | None = None
    if name is None or folder:
        files: Mapping[str, bytes] = read_files(root)
    elif name == LIVE:
        kept, files = _running(root, robot)
    else:
        files = _revision(root, name)
    project, diagnostics = check_files(root, as_robot(files, robot))
    if project is None:
        raise UsageError(f"{name or root} has errors: {ProjectError(diagnostics)}")
    return Version(name or str(root), project, files, deserialize(project.machine, kept.frozen) if kept else None)


def _running(root: Path, robot: str) -> tuple[StoredSnapshot, Mapping[str, bytes]]:
    home = Home(home_of(root, robot))
    keeper = SnapshotStore(home)
    kept = keeper.kept()
    if kept is None or not home.held():
        raise UsageError(f"no exhibition of {root.absolute()} is running on this machine: start it with `lumen run`")
    files = keeper.files(kept.bundle)
    if files is None:
        raise UsageError(f"the active files are no longer in {home.folder}")
    return kept, files


def _revision(root: Path, name: str) -> Mapping[str, bytes]:
    files = files_at(root, name)
    if files is None:
        raise UsageError(f"`{name}` is not a folder, a revision of {root}, or `{LIVE}`")
    if not files:
        raise UsageError(f"there is no project in {root} at `{name}`")
    return files
