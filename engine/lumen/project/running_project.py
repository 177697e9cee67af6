"""Find the project for a run: never the installed exhibition itself, since a run writes into its project.

If there is no project here or above, `lumen run` plays a copy of the shipped exhibition in the user's state folder. The
other commands about a run find the same copy.
"""

import hashlib
import os
import shutil
import tempfile
from functools import cache
from pathlib import Path

from lumen.errors import UsageError
from lumen.project.packaged import find_project, project_above, shipped_root
from lumen.project.project_folders import MAIN_FILE, PROJECT_FOLDERS
from lumen.upkeep.own_folders import state_folder


def is_substituted(path: str | Path | None) -> bool:
    """Return True if the shipped exhibition is used because no project was named or found here or above."""
    return path is None and project_above(Path.cwd()) is None


def running_project(path: str | Path | None = None) -> Path:
    """Return the folder of a project like `find_project`, but the copy of the shipped exhibition if there is one."""
    root = find_project(path)
    return copy if is_substituted(path) and (copy := copy_of_shipped()).is_dir() else root


def project_to_run(path: str | Path | None = None) -> Path:
    """Return the folder like `running_project`, and make a missing copy. Raises UsageError if that fails."""
    root = find_project(path)
    return _copied() if is_substituted(path) else root


def copy_of_shipped() -> Path:
    """Return the folder for a copy of the current shipped exhibition; another version has another folder."""
    return state_folder() / f"exhibition-{_digest()}"


@cache
def _digest() -> str:
    digest = hashlib.sha256()
    for file in _files():
        content = (shipped_root() / file).read_bytes()
        digest.update(b"%s\0%d\0" % (os.fsencode(file.as_posix()), len(content)) + content)
    return digest.hexdigest()[:12]


def _files() -> list[Path]:
    """Return the files of the shipped exhibition, relative to its folder."""
    root = shipped_root()
    found = (file for name in PROJECT_FOLDERS for file in (root / name).rglob("*") if file.is_file())
    return [Path(MAIN_FILE), *sorted(file.relative_to(root) for file in found)]


def _copied() -> Path:
    """Return the copy, made as a whole or not at all if it is missing: another run may make it at the same time.

    Permissions are not copied, so that a copy of a read-only installation can be written.
    """
    if (copy := copy_of_shipped()).is_dir():
        return copy
    draft = None
    try:
        copy.parent.mkdir(parents=True, exist_ok=True)
        draft = Path(tempfile.mkdtemp(prefix=f".{copy.name}-", dir=copy.parent))
        for file in _files():
            (draft / file).parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(shipped_root() / file, draft / file)
        draft.rename(copy)
    except OSError as error:
        if copy.is_dir():  # another run was faster
            return copy
        reason = (error.strerror or str(error)).lower()
        raise UsageError(
            f"the shipped exhibition can't be copied to {copy}: {reason}; set XDG_STATE_HOME to a writable folder,"
            " or make your own project with `lumen new DIR`"
        ) from None
    finally:
        if draft is not None:
            shutil.rmtree(draft, ignore_errors=True)
    return copy
