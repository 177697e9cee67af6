"""Find the project that a user wants to check, and the project to run: never the installed exhibition itself.

If neither the working directory nor a parent has a project, `lumen run` plays a copy of the shipped exhibition in the
user's state folder. The other commands about a run find the same copy.
"""

import hashlib
import os
from collections.abc import Iterator
from functools import cache
from itertools import islice
from pathlib import Path

from lumen.errors import UsageError
from lumen.project.packaged import find_project, misnamed_main_file, project_above, shipped_root
from lumen.project.project_folders import MAIN_FILE, PROJECT_FOLDERS
from lumen.upkeep.own_folders import state_folder

MAX_FOLDERS = 5_000
"""The maximum number of folders to search, which takes a fraction of a second."""
NAMED = 8
_PASSED_OVER = ("node_modules", "__pycache__", "site-packages")


def own_project(path: str | Path | None = None) -> Path:
    """Return the folder of a project: `path`, else the working directory or the nearest parent with a lumen.yaml.

    Raises UsageError if no project is found; the message lists those below. A given folder that contains no project is
    returned nevertheless, and the code that reads its files reports the missing lumen.yaml.
    """
    folder = project_above(Path.cwd()) if path is None else find_project(path)
    if folder and ((folder / MAIN_FILE).is_file() or (path is not None and not any(projects_below(folder)))):
        return folder
    where = f"in {folder.absolute()}" if folder else f"in {Path.cwd()} or above"
    raise UsageError(f"there is no {MAIN_FILE} {where}: {_instead(folder or Path.cwd())}")


def projects_below(folder: Path) -> Iterator[Path]:
    """Yield the folders below `folder` that have a lumen.yaml: level by level, by name within a level.

    Hidden folders, folders of installed packages and folders inside a found project are skipped. At most `MAX_FOLDERS`
    folders are searched.
    """
    waiting, looked = [folder], 0
    while waiting and looked < MAX_FOLDERS:
        level, waiting = waiting, []
        for here in level:
            looked += 1
            if here != folder and (here / MAIN_FILE).is_file():
                yield here
            elif looked < MAX_FOLDERS:
                waiting += _folders(here)


def _folders(here: Path) -> list[Path]:
    try:
        with os.scandir(here) as entries:
            names = [one.name for one in entries if one.is_dir(follow_symlinks=False)]
    except OSError:
        return []
    return [here / name for name in sorted(names) if not name.startswith(".") and name not in _PASSED_OVER]


def _instead(folder: Path) -> str:
    if there := next(filter(None, map(misnamed_main_file, (folder, *folder.parents))), ""):
        return f"rename {there} to {MAIN_FILE}"
    below = [_named(one) for one in islice(projects_below(folder), NAMED + 1)]
    if not below:
        return "pass the folder of a project, or make one with `lumen new DIR`"
    more = ", …" if len(below) > NAMED else ""
    return f"pass the folder of one of these projects: {', '.join(f'`{name}`' for name in below[:NAMED])}{more}"


def _named(folder: Path) -> str:
    """Return a folder's path relative to the working directory, as a user would type it."""
    return Path(os.path.relpath(folder)).as_posix()


def is_substituted(path: str | Path | None) -> bool:
    """Return True if the shipped exhibition is used because no project was named or found here or above."""
    return path is None and project_above(Path.cwd()) is None


def running_project(path: str | Path | None = None) -> Path:
    """Return the result of `find_project`, but instead of the shipped exhibition its copy, if there is one.

    Raises UsageError as `find_project` does.
    """
    root = find_project(path)
    return copy if is_substituted(path) and (copy := copy_of_shipped()).is_dir() else root


def project_to_run(path: str | Path | None = None) -> Path:
    """Return the result of `running_project`, after making the copy if it is needed and missing.

    Raises UsageError if the copy can't be made, or as `find_project` does.
    """
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

    Permissions are not copied, so that a copy of a read-only installation can be written. Raises UsageError on failure.
    """
    import shutil  # late, like tempfile: lint of a project does not need it
    import tempfile

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
