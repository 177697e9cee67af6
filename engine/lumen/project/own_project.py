"""Find the project that a user wants to check: their own, never the shipped one as a fallback."""

import os
from collections.abc import Iterator
from itertools import islice
from pathlib import Path

from lumen.errors import UsageError
from lumen.project.packaged import find_project, misnamed_main_file, project_above
from lumen.project.project_folders import MAIN_FILE

MAX_FOLDERS = 5_000
"""The maximum number of folders that are searched, in a fraction of a second; projects are usually near the top."""
NAMED = 8
_PASSED_OVER = ("node_modules", "__pycache__", "site-packages")


def own_project(path: str | Path | None = None) -> Path:
    """Return the folder of a project: `path`, else the working directory or the nearest parent with a lumen.yaml.

    Raises UsageError if no project is found; the message lists those below. A given folder without any is returned
    nevertheless, and the code that reads its files reports the missing lumen.yaml.
    """
    folder = project_above(Path.cwd()) if path is None else find_project(path)
    if folder and ((folder / MAIN_FILE).is_file() or (path is not None and not any(projects_below(folder)))):
        return folder
    where = f"in {folder.absolute()}" if folder else f"in {Path.cwd()} or above"
    raise UsageError(f"there is no {MAIN_FILE} {where}: {_instead(folder or Path.cwd())}")


def projects_below(folder: Path) -> Iterator[Path]:
    """Yield the folders with a lumen.yaml, the upper ones first, then by name.

    Hidden and installed folders are skipped, and so are folders inside a project.
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
    """Return a folder's path relative to the working directory, as one would type it."""
    return Path(os.path.relpath(folder)).as_posix()
