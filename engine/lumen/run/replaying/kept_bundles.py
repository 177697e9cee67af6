"""The files that ran when a journal was written, as projects."""

from dataclasses import replace
from pathlib import Path

from lumen.language.machines import MachineDefinition
from lumen.language.projects import Project
from lumen.lint import check_files
from lumen.project.chosen_robot import as_robot
from lumen.project.home import Home, home_of
from lumen.run.snapshot_store import SnapshotStore


class KeptBundles:
    """The bundles in the home of the project in `root`, each read on first use; `robot` is one of its `robots:`."""

    def __init__(self, root: Path, robot: str = "") -> None:
        self._root, self.robot, self._store = root, robot, SnapshotStore(Home(home_of(root, robot)))
        self._read: dict[str, Project | None] = {}

    def project(self, hash: str, behavior: str) -> Project | None:
        """Return the project of a hash with that behaviour; None if it was not kept, or this version can't read it."""
        if hash not in self._read:
            self._read[hash] = self.load(hash)
        project = self._read[hash]
        if project is None or behavior not in project.behaviors:
            return None
        return project if project.behavior == behavior else replace(project, behavior=behavior)

    def load(self, hash: str) -> Project | None:
        """Read a project anew; None if it was not kept or can't be read."""
        files = self.files(hash)
        return check_files(self._root, files)[0] if files else None

    def files(self, hash: str) -> dict[str, bytes] | None:
        """Return the files of a bundle as this robot reads them, None if they were not kept."""
        files = self._store.files(hash)
        return as_robot(files, self.robot) if files else None

    def machine(self, hash: str, behavior: str) -> MachineDefinition | None:
        """Return the machine of `project`, or None."""
        project = self.project(hash, behavior)
        return project.machine if project else None
