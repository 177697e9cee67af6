"""Loads and checks a whole project in a folder."""

from pathlib import Path

from lumen.errors import ProjectError
from lumen.language.projects import Project
from lumen.project.files import read_files
from lumen.project.packaged import find_project
from lumen.upkeep.garbage import gc_paused

__all__ = ["Project", "load"]


@gc_paused()
def load(path: str | Path | None = None, *, robot: str = "") -> Project:
    """Return the project in that folder; without a path the one here or above, otherwise the shipped one.

    For a project with several robots, `robot` selects one; the default is the first. Raises ProjectError with the
    diagnostics if its files have errors, and UsageError if the folder does not exist.
    """
    from lumen.lint import check_files  # late: a run reads its files in another process, or knows them already

    root = find_project(path)
    project, diagnostics = check_files(root, read_files(root, robot))
    if project is None:
        raise ProjectError(diagnostics)
    return project
