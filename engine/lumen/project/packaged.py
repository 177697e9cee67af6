"""Where the shipped exhibition and the engine's own schemas are, and which project is meant by a path or by none."""

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
    """The folder of the shipped exhibition: inside the wheel, else the repository's root."""
    inside = PACKAGE / "exhibition"
    return inside if inside.is_dir() else PACKAGE.parents[1]


def schema_folder() -> Path:
    """The folder of `KIND.schema.json`; always the engine's own, whatever a project holds."""
    return shipped_root() / "schemas"


def project_above(here: Path) -> Path | None:
    """This folder or its nearest parent with a lumen.yaml; None where there is none."""
    return next((folder for folder in (here, *here.parents) if (folder / MAIN_FILE).is_file()), None)


def misnamed_main_file(folder: Path) -> str:
    """The file in that folder that was probably meant to be its lumen.yaml; empty if no name is similar."""
    try:
        names = sorted(os.listdir(folder))
    except OSError:
        return ""
    return next((name for name in names if name != MAIN_FILE and _MISNAMED.fullmatch(name)), "")


def find_project(path: str | Path | None = None) -> Path:
    """The folder of a project: `path`, else the working directory or the nearest parent with a lumen.yaml, else the
    shipped one. `path` may name the folder or its lumen.yaml. Raises UsageError if there is no such folder, or if
    one of them holds a lumen.yaml under another name.
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
