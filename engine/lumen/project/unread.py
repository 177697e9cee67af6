"""Files of a project that nothing reads, because of their folder or the ending of their name."""

import os
from collections.abc import Callable, Collection, Iterator
from functools import lru_cache
from pathlib import Path, PurePosixPath
from typing import NamedTuple

from lumen.language.diagnostics import did_you_mean, nearest
from lumen.language.folders import DRIVERS_FOLDER, KNOWLEDGE_FOLDER
from lumen.project.files import MISTAKEN_FOLDERS
from lumen.project.misplaced import listed_in, misnamed_in
from lumen.project.project_folders import (
    ALL_FOLDERS,
    GESTURES_FOLDER,
    KINDS,
    LIFE_FOLDER,
    MAIN_FILE,
    MESSAGES,
    MODELS,
    MOTIONS,
    PROJECT_FOLDERS,
    SKILLS,
    endings_in,
    file_kinds,
    gestures_of,
    is_robots_own,
    kind_in,
    life_of,
)

MAX_DEPTH = 3
"""The number of levels of an unread folder that are searched for its first file."""
MAX_LISTED = 500
"""The maximum number of entries of an unread folder that are examined."""

_SCHEMAS = MESSAGES.partition("/")[0]
_SCHEMA_ENDING = ".schema.json"
_OF_PROGRAMS = (SKILLS, MODELS)
"""Folders in which programs and models keep files of their own, of any kind."""
_PROSE = ("markdown", "mdown", "mkd", "txt")


class Unread(NamedTuple):
    """A file that is not read."""

    file: str
    """The path of the file."""
    message: str
    """The reason, in words."""
    hint: str
    """The remedy, in words."""


def unread_in(root: Path, models: Collection[str], look: Callable[[str], object]) -> Iterator[Unread]:
    """Yield files that a person probably wrote for this project and that are not read; of a folder, only the first.

    `models` are the robot models whose own folders in motions/ are read. `look` is called with each folder that the
    result depends on. Folders that are reported for capital letters, or by the files read from them, are left out.
    """
    yield from _at_root(root, look)
    for folder in PROJECT_FOLDERS:
        yield from _within(root, folder, models, look)


def _within(root: Path, folder: str, models: Collection[str], look: Callable[[str], object]) -> Iterator[Unread]:
    """Yield the unread files in a folder whose files are read, and those in its subfolders."""
    look(f"{root}/{folder}")
    listed = listed_in(root, folder)
    misnamed = {each.there.rstrip("/"): PurePosixPath(each.meant).name for each in misnamed_in(root, folder, listed)}
    endings = (_SCHEMA_ENDING,) if folder == MESSAGES else endings_in(folder)
    for name in listed:
        path = f"{folder}/{name}"
        if endings and name.endswith(endings):
            continue
        if path in misnamed:
            if is_robots_own(folder):  # lint reports those of the folders for all robots
                yield Unread(
                    path,
                    f"Lumen does not read this: its name is not `{misnamed[path]}`",
                    f"rename it to {misnamed[path]}",
                )
            continue
        if name.startswith((".", "_")):
            continue
        if os.path.isdir(f"{root}/{path}"):
            if path in ALL_FOLDERS or (kind_in(path) and _robot_of(path) in models):
                yield from _within(root, path, models, look)
            elif not (is_robots_own(path) and _has_own(root, path)):  # such a folder is reported with its motions
                yield from _of_folder(root, path, models, look)
        else:
            yield from _of_file(folder, name, listed)


def _of_folder(root: Path, folder: str, models: Collection[str], look: Callable[[str], object]) -> Iterator[Unread]:
    """Yield the first file in a folder that is not read, if its ending is that of a project's files."""
    above = folder.rpartition("/")[0]
    endings = tuple(dict.fromkeys((*(endings_in(above) or (".json",)), ".yaml", ".yml")))
    wanted = tuple(ending for ending in endings if ending != ".xml")
    depth = 1 if above == SKILLS else MAX_DEPTH
    if first := _first(root, folder, wanted, depth, look):
        yield Unread(first, f"files in {folder}/ are not read", _home_hint(folder, models))


def _first(root: Path, folder: str, endings: tuple[str, ...], depth: int, look: Callable[[str], object]) -> str:
    """Return the first file with one of these endings in a folder and those in it; empty if there is none."""
    look(f"{root}/{folder}")
    inside = [name for name in listed_in(root, folder)[:MAX_LISTED] if not name.startswith((".", "_"))]
    if MAIN_FILE in inside:  # a project of its own
        return ""
    if found := next((name for name in inside if name.endswith(endings)), ""):
        return f"{folder}/{found}"
    deeper = (f"{folder}/{name}" for name in inside if depth > 1 and os.path.isdir(f"{root}/{folder}/{name}"))
    return next((found for each in deeper if (found := _first(root, each, endings, depth - 1, look))), "")


def _home_hint(folder: str, models: Collection[str]) -> str:
    """Return a hint about where the files of a folder that is not read belong."""
    above, _, name = folder.rpartition("/")
    if above in (LIFE_FOLDER, GESTURES_FOLDER) and name in models:
        own = life_of(name) if above == LIFE_FOLDER else gestures_of(name)
        return f"move the files to {own}/"
    if is_robots_own(folder):
        return robots_own_hint(name, models)
    inside = {PurePosixPath(path).name: path for path in ALL_FOLDERS if str(PurePosixPath(path).parent) == above}
    if is_robots_own(above):
        robot = PurePosixPath(above).name
        inside = {PurePosixPath(each).name: each for each in (life_of(robot), gestures_of(robot))}
    if near := nearest(name, inside):
        return f"did you mean `{inside[near]}/`?"
    known = {PurePosixPath(path).name: path for path in KINDS}
    if near := nearest(name, known):
        return f"move the files to {known[near]}/"
    home = MOTIONS if is_robots_own(above) else MESSAGES if above == _SCHEMAS else above
    return f"move the files that belong to the exhibition to {home}/"


def robots_own_hint(name: str, models: Collection[str]) -> str:
    """Return a hint about the right name of a folder in motions/ that is named after no robot model."""
    shared = {PurePosixPath(path).name: path for path in KINDS if path.startswith(f"{MOTIONS}/")}
    if (near := nearest(name, {*models, *shared})) in shared:
        return f"did you mean `{shared[near]}/`?"
    return f"name the folder after a robot model: {did_you_mean(name, models, 'available:')}"


def _of_file(folder: str, name: str, listed: Collection[str]) -> Iterator[Unread]:
    """Yield a file with an ending that is nearly right, or right in another folder.

    Backups are left out, and copies of a file that is read: `listed` are the names in the folder.
    """
    stem, dot, ending = name.rpartition(".")
    if name.endswith(("~", ".bak", ".orig", ".tmp")) or stem.isupper() or not endings_in(folder):
        return
    if folder == MESSAGES:
        meant = f"{_message_of(name)}{_SCHEMA_ENDING}" if ending in ("json", "yaml", "yml") else ""
    elif folder == KNOWLEDGE_FOLDER and dot and ending.lower() in _PROSE:
        meant = f"{stem}.md"
    elif folder in _OF_PROGRAMS:
        meant = f"{stem}.yaml" if dot and ending != "yml" and nearest(ending.lower(), ("yaml",)) else ""
    elif not dot:
        meant = f"{name}.yaml" if name == name.lower() else ""
    else:
        meant = f"{stem}.yaml" if ending == "json" or nearest(ending.lower(), ("yaml",)) else ""
    if meant and meant not in listed:
        message = f"Lumen does not read this: its name does not end in {_ending_of(meant)}"
        yield Unread(f"{folder}/{name}", message, f"rename it to {meant}")


def _ending_of(name: str) -> str:
    return _SCHEMA_ENDING if name.endswith(_SCHEMA_ENDING) else PurePosixPath(name).suffix


def _message_of(file: str) -> str:
    """Return the name of the message that a file in schemas/messages/ describes: `face` for `face.shema.json`."""
    stem, dot, last = file.rpartition(".")[0].rpartition(".")
    return stem if dot and nearest(last.lower(), ("schema",)) else f"{stem}{dot}{last}"


def _at_root(root: Path, look: Callable[[str], object]) -> Iterator[Unread]:
    """Yield stray schemas, and the first file of each folder of the root with nearly the name of a project's folder."""
    look(str(root))
    schemas = {f"{kind}{_SCHEMA_ENDING}" for kind in file_kinds()}
    for name in listed_in(root, _SCHEMAS):
        if name.endswith(_SCHEMA_ENDING) and name not in schemas:
            message = "Lumen does not read this as the schema of a message"
            yield Unread(f"{_SCHEMAS}/{name}", message, f"move it to {MESSAGES}/, if it describes one")
    for name in listed_in(root, ""):
        if name in PROJECT_FOLDERS or name in MISTAKEN_FOLDERS or name == DRIVERS_FOLDER or name.startswith("."):
            continue
        if (
            name.lower() in ALL_FOLDERS
            or not (meant := _folder_named_like(name))
            or not os.path.isdir(f"{root}/{name}")
        ):
            continue
        endings = (".py",) if meant == DRIVERS_FOLDER else endings_in(meant) or (".json",)
        if first := _first(root, name, endings, 1, look):
            yield Unread(first, f"files in {name}/ are not read", f"did you mean `{meant}/`?")


@lru_cache  # a folder of the root is compared again at each check
def _folder_named_like(name: str) -> str:
    """Return the folder of a project whose name is similar; empty if no name is."""
    known = {PurePosixPath(path).name: path for path in (*reversed(tuple(KINDS)), *PROJECT_FOLDERS, DRIVERS_FOLDER)}
    near = nearest(name, known)
    return known[near] if near else ""


def _robot_of(folder: str) -> str:
    """Return the robot model whose own files a folder in motions/ holds."""
    parts = PurePosixPath(folder).parts
    return parts[1] if len(parts) > 1 else ""


def _has_own(root: Path, folder: str) -> bool:
    """Return True if a robot's folder has files that are read with the project, whether or not they are used."""
    robot = PurePosixPath(folder).name
    own = (folder, life_of(robot), gestures_of(robot))
    return any(name.endswith(".yaml") for each in own for name in listed_in(root, each))
