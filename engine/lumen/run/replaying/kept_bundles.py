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
    """The bundles in the home of the project in `root`, each read when it is first asked for.

    `robot` is one of its `robots:`.
    """

    def __init__(self, root: Path, robot: str = "") -> None:
        self._root, self.robot, self._store = root, robot, SnapshotStore(Home(home_of(root, robot)))
        self._read: dict[str, Project | None] = {}

    def project(self, hash: str, behavior: str) -> Project | None:
        """The project of that hash with that behaviour, None where it was not kept, or this Lumen can't read it."""
        if hash not in self._read:
            self._read[hash] = self.load(hash)
        project = self._read[hash]
        if project is None or behavior not in project.behaviors:
            return None
        return project if project.behavior == behavior else replace(project, behavior=behavior)

    def load(self, hash: str) -> Project | None:
        """That project, read anew."""
        files = self.files(hash)
        return check_files(self._root, files)[0] if files else None

    def files(self, hash: str) -> dict[str, bytes] | None:
        """The files of that bundle as this robot reads them, None where they were not kept."""
        files = self._store.files(hash)
        return as_robot(files, self.robot) if files else None

    def machine(self, hash: str, behavior: str) -> MachineDefinition | None:
        """The same of the behaviour alone."""
        project = self.project(hash, behavior)
        return project.machine if project else None
