"""Copies of projects of this repository."""

import shutil
from collections.abc import Iterable
from pathlib import Path

from lumen.project.project_folders import MAIN_FILE, PROJECT_FOLDERS
from tests import ROOT

SHIPPED_FOLDERS = tuple(name for name in PROJECT_FOLDERS if (ROOT / name).is_dir())
"""The folders that the shipped project has of those that a project can have."""


def copied_project(source: Path, target: Path) -> Path:
    """Copy a project's folder without what runs left in it, and return the copy; the target may exist.

    The shipped project is copied without the rest of the repository, in which its virtual environment may be.
    """
    return Path(shutil.copytree(source, target, ignore=_left_out, dirs_exist_ok=True))


def _left_out(folder: str, names: Iterable[str]) -> set[str]:
    if Path(folder) == ROOT:
        return {*names} - {MAIN_FILE, *SHIPPED_FOLDERS}
    return {".lumen", "__pycache__"}.intersection(names)
