"""Files that are not read because their names are only nearly right: `wave.yaml.txt`, `wave.YAML`, `Motions/`."""

import os
import re
from collections.abc import Iterator
from pathlib import Path, PurePosixPath
from typing import NamedTuple

from lumen.project.files import belongs
from lumen.project.project_folders import ALL_FOLDERS, endings_in

_ENDING = re.compile(r"(?P<stem>.+?)\s*\.(?:(?P<yaml>ya?ml)|(?P<other>md|json|xml))\s*(?:\.te?xt)?\s*", re.IGNORECASE)


class Misnamed(NamedTuple):
    """The path of a file or folder as it is and as it should be, both from the project's root."""

    there: str
    meant: str


def misnamed_in(root: Path, folder: str) -> Iterator[Misnamed]:
    """Yield files of a project folder whose ending is nearly right, and folders with capital letters."""
    endings, listed = endings_in(folder), _listed(root, folder)
    for name in listed:
        path = f"{folder}/{name}" if folder else name
        lowered = path.lower()
        if lowered != path and lowered in ALL_FOLDERS and not (root / lowered).exists():
            yield Misnamed(f"{path}/", f"{lowered}/")
        elif (found := _ENDING.fullmatch(name)) and not belongs(path) and (root / path).is_file():
            ending = f".{found['other'] or 'yaml'}".lower()
            meant = found["stem"] + ending
            if ending in endings and meant not in listed and not name.startswith("."):
                yield Misnamed(path, f"{folder}/{meant}")


def misnamed_for(root: Path, folder: str, name: str) -> Misnamed | None:
    """Return the misnamed file that was probably meant to have that name in a folder of the project."""
    above = ["", *map(str, reversed(PurePosixPath(folder).parents[:-1])), folder]
    found = (each for one in above for each in misnamed_in(root, one))
    fits = (
        each
        for each in found
        if each.meant.rstrip("/") in above or each.meant.partition(".")[0].lower() == f"{folder}/{name}".lower()
    )
    return next(fits, None)


def _listed(root: Path, folder: str) -> list[str]:
    """The names in a folder of the project; none if the folder is outside of the project."""
    try:
        listed = sorted(os.listdir(root / folder))
        return listed if _is_inside(root, folder) else []
    except (OSError, RuntimeError):  # the latter for links in a circle
        return []


def _is_inside(root: Path, folder: str) -> bool:
    """Return True if a folder lies in the project after links are resolved."""
    parts = PurePosixPath(folder).parts
    if not any((root / "/".join(parts[: i + 1])).is_symlink() for i in range(len(parts))):
        return True
    return (root / folder).resolve().is_relative_to(root.resolve())
