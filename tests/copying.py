"""Copies of projects of this repository."""

import shutil
from pathlib import Path

from lumen.project.project_folders import PROJECT_FOLDERS
from tests import ROOT

SHIPPED_FOLDERS = tuple(name for name in PROJECT_FOLDERS if (ROOT / name).is_dir())
"""The folders that the shipped project has of those that a project can have."""


def copied_project(source: Path, target: Path) -> Path:
    """Copy a project's folder without what runs left in it, and return the copy; the target may exist."""
    left = shutil.ignore_patterns(".lumen", "__pycache__")
    return Path(shutil.copytree(source, target, ignore=left, dirs_exist_ok=True))
