"""Files that a model names: whether they lie in models/, and whether they are there."""

import os
from pathlib import Path, PurePosixPath

from lumen.language.diagnostics import nearest

_MODELS = "models"


def outside(root: Path | None, folder: str, name: str) -> bool:
    """Whether a name leads out of models/, or through a link out of the project in `root`; None is no folder at all."""
    path = os.path.normpath(os.path.join(_MODELS, folder, name))
    if "\\" in name or "\0" in name or not path.startswith(_MODELS + os.sep):
        return True
    if root is None:
        return False
    project = os.path.realpath(root)
    return not os.path.realpath(os.path.join(project, path)).startswith(project.rstrip(os.sep) + os.sep)


def missing(root: Path | None, folder: str, name: str) -> str:
    """What to do about a file in models/ that is not there; empty where it is, or where nobody knows."""
    if root is None or not (root / _MODELS).is_dir() or _there(root / _MODELS / folder / name):
        return ""
    beside = root / _MODELS / folder
    near = nearest(PurePosixPath(name).name, [path.name for path in beside.glob("*")] if beside.is_dir() else [])
    return f"did you mean `{near}`?" if near else "put it there, or delete what names it"


def _there(path: Path) -> bool:
    try:
        return path.is_file()
    except OSError:
        return False
