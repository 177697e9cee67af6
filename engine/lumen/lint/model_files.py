"""Files that a model names: whether they lie in models/, and whether they are there."""

import os
from pathlib import Path, PurePosixPath

from lumen.language.diagnostics import nearest
from lumen.project.draft import ProjectDraft

_MODELS = "models"


def outside(draft: ProjectDraft, folder: str, name: str) -> bool:
    """Whether a name leads out of models/, or through a link out of the project where that lies in a folder."""
    path = os.path.normpath(os.path.join(_MODELS, folder, name))
    if "\\" in name or "\0" in name or not path.startswith(_MODELS + os.sep):
        return True
    if draft.root is None:
        return False
    real, project = draft.looks.at(draft.root / path), draft.looks.at(draft.root)
    return not real.startswith(project.rstrip(os.sep) + os.sep)


def missing(draft: ProjectDraft, folder: str, name: str) -> str:
    """What to do about a file in models/ that is not there; empty where it is, or where nobody knows."""
    if draft.root is None:
        return ""
    models = draft.root / _MODELS
    beside = models / folder
    for path in (models, beside, beside / name):
        draft.looks.at(path)
    if not models.is_dir() or _there(beside / name):
        return ""
    near = nearest(PurePosixPath(name).name, [path.name for path in beside.glob("*")] if beside.is_dir() else [])
    return f"did you mean `{near}`?" if near else "add the file, or delete the reference to it"


def _there(path: Path) -> bool:
    try:
        return path.is_file()
    except OSError:
        return False
