"""Find the shipped exhibition, the engine's own schemas, and the project for a given path or for none."""

import os
import re
from functools import cache
from pathlib import Path

from lumen.errors import UsageError
from lumen.project.project_folders import MAIN_FILE

_MISNAMED = re.compile(r"lumen\s*\.ya?ml\s*(\.te?xt)?\s*", re.IGNORECASE)
PACKAGE = Path(__file__).parents[1]
"""The folder of the engine, which holds the shipped exhibition if Lumen was installed from a wheel."""


@cache
def shipped_root() -> Path:
    """Return the folder of the shipped exhibition: inside the wheel, else the repository's root."""
    inside = PACKAGE / "exhibition"
    return inside if inside.is_dir() else PACKAGE.parents[1]


def schema_folder() -> Path:
    """Return the engine's own folder of `KIND.schema.json`, even if a project has such a folder too."""
    return shipped_root() / "schemas"


def project_above(here: Path) -> Path | None:
    """Return this folder or its nearest parent with a lumen.yaml; None if no folder has one."""
    return next((folder for folder in (here, *here.parents) if (folder / MAIN_FILE).is_file()), None)


def misnamed_main_file(folder: Path) -> str:
    """Return the file in that folder that was probably meant to be its lumen.yaml; empty if no name is similar."""
    try:
        names = sorted(os.listdir(folder))
    except OSError:
        return ""
    return next((name for name in names if name != MAIN_FILE and _MISNAMED.fullmatch(name)), "")


def find_project(path: str | Path | None = None) -> Path:
    """Return the folder of a project: `path`, or the nearest project if `path` is None.

    The nearest project is the working directory or its nearest parent with a lumen.yaml, else the shipped exhibition.
    `path` may name the folder or its lumen.yaml. Raises UsageError if there is no such folder, or if one of the
    searched folders holds a lumen.yaml under another name.
    """
    if path is None:
        here = Path.cwd()
        if found := project_above(here):
            return found
        for above in (here, *here.parents):
            if there := misnamed_main_file(above):
                raise UsageError(f"there is no {MAIN_FILE} in {above}: rename {there} to {MAIN_FILE}")
        return shipped_root()
    folder = Path(path)
    try:
        if folder.name == MAIN_FILE and folder.is_file():
            folder = folder.parent
        if folder.is_dir():
            return folder
        reason = "is a file: pass the folder that contains its lumen.yaml" if folder.exists() else "does not exist"
    except (OSError, ValueError) as error:
        reason = f"can't be read: {getattr(error, 'strerror', None) or error}"
    raise UsageError(f"{folder} {reason}")
