"""Read all files of a project once, so that they can't change while it is built."""

import hashlib
import os
import stat
from collections.abc import Iterator, Mapping
from itertools import accumulate
from pathlib import Path
from unicodedata import normalize

from lumen.feature import table
from lumen.project.chosen_model import choice
from lumen.project.chosen_robot import CHOSEN_ROBOT, as_robot
from lumen.project.common_words import with_common_words
from lumen.project.kept_contents import KeptContents
from lumen.project.project_folders import (
    FLEET_FILE,
    KINDS,
    MAIN_FILE,
    MOTIONS,
    endings_in,
    gestures_of,
    is_robots_own,
    is_root_file,
    life_of,
)
from lumen.upkeep.regular_files import MEGABYTE

MAX_FILE_BYTES = 4_000_000
"""The maximum size of one file [bytes]; a behaviour of ten thousand states is smaller."""

MAX_PROJECT_BYTES = 32_000_000
"""The maximum size of all files together [bytes]."""

MAX_FOLDER_FILES = 5_000
"""The maximum number of files in a folder; if there are more, the first in alphabetical order are read."""

LEADS_OUT = b"it is a link that leads out of the project"

MISTAKEN_FOLDERS: Mapping[str, str] = {
    "stories": "behaviors/stories",
    "words": "behaviors/words",
    "sayings": "behaviors/sayings",
    "behaviours": "behaviors",
    "behavior": "behaviors",
    "motion": "motions",
    "gestures": "motions",
    "life": "motions/life",
    "controllers": "fuzzy",
    "function": "functions",
}
"""Folders in a project's root that are not read, and the folders that were probably meant, which lint suggests."""


class Unreadable(bytes):
    """A placeholder for the content of a file that can't be read; its bytes are the reason, in words."""


def read_files(root: Path, robot: str = "", kept: KeptContents | None = None) -> dict[str, bytes]:
    """Return the content of every file of a project, by its path from the project's root, sorted. Never raises.

    Links within the project are followed. Nothing outside the project is read, not even the list of a folder: a folder
    that lies outside is `Unreadable`, as is a file that can't be read or is too large. If `robot` is given, the files
    are read for that robot. A file in `kept` that has not changed is not read again.
    """
    read = _Reader(root, kept)
    found = {name: content for name in (MAIN_FILE, *table("files")) if (content := read.file(name)) is not None}
    for folder in dict.fromkeys((*KINDS, *MISTAKEN_FOLDERS, *_robots_own(root))):
        endings = (".yaml",) if folder in MISTAKEN_FOLDERS else endings_in(folder)
        if outside := next((each for each in _within(folder) if read.leads_out(each)), None):
            if folder not in MISTAKEN_FOLDERS:
                found[outside] = Unreadable(LEADS_OUT)
            continue
        if any(isinstance(found.get(each), Unreadable) for each in _within(folder)):
            continue
        try:
            names = _names(os.path.join(root, folder), endings)
        except OSError as error:
            if folder not in MISTAKEN_FOLDERS:
                found[folder] = Unreadable(_reason(error))
            continue
        for name in names:
            content = read.file(f"{folder}/{name}")
            if content is not None:
                file = f"{folder}/{os.fsencode(name).decode('utf-8', 'replace')}"
                found[composed(file) if composed(name) == name or composed(name) not in names else file] = content
    return dict(sorted(as_robot(with_common_words({**found, **choice()}), robot).items()))


def composed(file: str) -> str:
    """Return a file name in composed form; macOS may have saved its accents as separate characters."""
    return normalize("NFC", file) if file == normalize("NFD", file) else file


def on_disk(root: Path, file: str) -> Path:
    """Return the path of a file in a project, with accents in the form in which they were saved."""
    path, decomposed = root / file, root / normalize("NFD", file)
    return decomposed if not path.exists() and decomposed.exists() else path


def read_main_file(root: Path) -> bytes:
    """Return the content of lumen.yaml; empty if the file is absent."""
    return _Reader(root).file(MAIN_FILE) or b""


def belongs(path: str) -> bool:
    """Return True if a file of that path from the project's root is part of a project."""
    folder, _, name = path.rpartition("/")
    return is_root_file(path) or (not name.startswith(".") and name.endswith(endings_in(folder)))


def fingerprint(files: Mapping[str, bytes]) -> str:
    """Return the hash of all paths and contents, without fleet.yaml and the chosen robot."""
    digest = hashlib.sha256()
    for path, content in sorted(files.items()):
        if path in (FLEET_FILE, CHOSEN_ROBOT):
            continue
        digest.update(f"{len(path)} {path} {len(content)} ".encode("utf-8", "surrogatepass") + content)
    return digest.hexdigest()


def _robots_own(root: Path) -> list[str]:
    """Return the folders in motions/, each with the motions of one robot, and those with its life and gestures."""
    try:
        listed = sorted(os.listdir(root / MOTIONS))
    except OSError:
        return []
    names = [name for name in listed if "." not in name and os.path.isdir(root / MOTIONS / name)]
    shown = [os.fsencode(name).decode("utf-8", "replace") for name in names][:MAX_FOLDER_FILES]
    own = [name for name in shown if is_robots_own(f"{MOTIONS}/{name}")]
    return [
        *(f"{MOTIONS}/{name}" for name in shown),
        *(each for name in own for each in (life_of(name), gestures_of(name)) if os.path.isdir(root / each)),
    ]


def _within(folder: str) -> Iterator[str]:
    """Yield the folders that a folder of the project lies in, from the outermost, then the folder itself."""
    yield from accumulate(folder.split("/"), "{}/{}".format)


def _names(folder: str, endings: tuple[str, ...]) -> list[str]:
    """Return the file names in a folder, sorted, without dotfiles; none if it is missing. Raises other OSErrors."""
    try:
        listed = os.listdir(folder)
    except FileNotFoundError:
        if not os.path.islink(folder):
            return []
        raise
    return sorted(name for name in listed if name.endswith(endings) and not name.startswith("."))[:MAX_FOLDER_FILES]


def _reason(error: OSError) -> bytes:
    """Return in words why a file or a folder can't be read; the system's own words for rare errors."""
    if isinstance(error, NotADirectoryError):
        return b"it is a file, and should be a folder"
    if isinstance(error, FileNotFoundError):
        return b"what it links to is not there"
    return (error.strerror or "the system refuses").lower().encode()


class _Reader:
    """Reads files of a project and adds up their sizes."""

    def __init__(self, root: Path, kept: KeptContents | None = None) -> None:
        self._kept = kept or KeptContents()
        self._root, self._real, self._left = root, os.path.realpath(root), MAX_PROJECT_BYTES

    def leads_out(self, name: str) -> bool:
        """Return True if a file or folder of the project is a link to a place outside it."""
        real = os.path.realpath(os.path.join(self._root, name))
        return real != self._real and not real.startswith(self._real.rstrip(os.sep) + os.sep)

    def file(self, name: str) -> bytes | None:
        """Return the content, `Unreadable` with the reason if it can't be read, or None if there is no such file."""
        path = os.path.join(self._root, name)
        try:
            entry = os.lstat(path)
            if stat.S_ISLNK(entry.st_mode) and self.leads_out(name):
                return Unreadable(LEADS_OUT)
            content = self._kept.read(path, entry, MAX_FILE_BYTES)
        except FileNotFoundError:
            return Unreadable(b"the file that it links to does not exist") if os.path.islink(path) else None
        except OSError as error:
            return Unreadable(_reason(error))
        if len(content) > self._left:
            return Unreadable(f"the project holds more than {MAX_PROJECT_BYTES // MEGABYTE} MB".encode())
        self._left -= len(content)
        return content
