"""Results of explorations, stored under `.lumen/explored/` by everything on which they depend, to avoid repetitions."""

import json
from collections.abc import Mapping
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

from lumen.language.diagnostics import Place
from lumen.language.projects import Project
from lumen.project.home import Home, home_of
from lumen.run.coverage import Gap
from lumen.run.exploring import Explored, ExploredFinding
from lumen.run.workers.tasks import engine, name_of
from lumen.upkeep.own_folders import private_folder

FOLDER = "explored"
MAX_KEPT = 20
"""The number of explorations that are stored of a project; more replace the oldest."""


class KeptExplorations:
    """The stored explorations of a project. A folder or file that can't be used counts as empty."""

    def __init__(self, project: Project) -> None:
        self._home = Home(home_of(Path(project.root)) / FOLDER)
        self._content = [project.hash, repr(project.body.name), list(project.languages), engine()]

    def recall(self, behavior: str, bound: int, home: str) -> Explored | None:
        """Return the earlier result for the same files, software and options, else None."""
        try:
            return _from_json(self._home.read_json(self._name(behavior, bound, home)))
        except (KeyError, TypeError, ValueError, AttributeError):
            return None

    def keep(self, explored: Explored, bound: int, home: str) -> None:
        """Save a result, and delete the oldest ones; do nothing if the folder can't be written."""
        try:
            private_folder(self._home.folder.parent)
            private_folder(self._home.folder)
            files = sorted(self._home.folder.glob("*.json"), key=lambda file: file.stat().st_mtime)
            for old in files[: -MAX_KEPT + 1]:
                old.unlink()
        except OSError:
            return
        self._home.write_json(self._name(explored.behavior, bound, home), asdict(explored))

    def _name(self, behavior: str, bound: int, home: str) -> str:
        return f"{name_of(json.dumps([*self._content, behavior, bound, home]).encode())}.json"


def _from_json(data: Any) -> Explored | None:
    if not isinstance(data, Mapping):
        return None
    findings = tuple(ExploredFinding(**{**row, "place": Place(*row["place"])}) for row in data["findings"])
    unseen = tuple(Gap(Place(*place), str(what)) for place, what in data["unseen"])
    explored = Explored(**{**data, "findings": findings, "unseen": unseen, "kept": tuple(data["kept"])})
    return replace(explored, known=True)
