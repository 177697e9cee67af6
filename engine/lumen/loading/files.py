"""All files of a project, read once; what is built from them can't change under the builder's hands."""

import hashlib
import os
import stat
from collections.abc import Iterator, Mapping
from pathlib import Path

from lumen.loading.packaged import MAIN_FILE

PROJECT_FOLDERS = ("behaviors", "fuzzy", "motions", "schemas", "models")
"""What belongs to a project beside lumen.yaml."""

MAX_FILE_BYTES = 4_000_000
"""Of one file; a behaviour of ten thousand states is smaller."""

_READ: Mapping[str, tuple[str, ...]] = {
    "behaviors": (".yaml", ".yml"),
    "behaviors/stories": (".yaml", ".yml"),
    "fuzzy": (".yaml", ".yml"),
    "motions": (".yaml", ".yml"),
    "models": (".yaml", ".yml", ".xml"),
    "models/passages": (".yaml", ".yml"),
    "schemas/messages": (".json",),
}


class Unreadable(bytes):
    """Stands in place of the content of a file that can't be read; its text is the reason, in words."""


def read_files(root: Path) -> dict[str, bytes]:
    """The content of every file that counts, by its path from the project's root, sorted; nothing here raises."""
    found = {MAIN_FILE: content} if (content := _read(root / MAIN_FILE)) is not None else {}
    for folder, endings in _READ.items():
        for name in _names(root / folder, endings):
            content = _read(root / folder / name)
            if content is not None:
                found[f"{folder}/{os.fsencode(name).decode('utf-8', 'replace')}"] = content
    return dict(sorted(found.items()))


def read_main_file(root: Path) -> bytes:
    """lumen.yaml alone, empty where there is none."""
    return _read(root / MAIN_FILE) or b""


def belongs(path: str) -> bool:
    """Whether a file of that path from the project's root counts."""
    folder, _, name = path.rpartition("/")
    return path == MAIN_FILE or (not name.startswith(".") and name.endswith(_READ.get(folder, ())))


def counts(file: str) -> bool:
    """Whether a file of that path, from the project's root, is one that is read."""
    folder, _, name = file.rpartition("/")
    return file == MAIN_FILE or (name.endswith(_READ.get(folder, ())) and not name.startswith("."))


def fingerprint(files: Mapping[str, bytes]) -> str:
    """The hash of all paths and contents."""
    digest = hashlib.sha256()
    for path, content in sorted(files.items()):
        digest.update(f"{len(path)} {path} {len(content)} ".encode("utf-8", "surrogatepass") + content)
    return digest.hexdigest()


def _names(folder: Path, endings: tuple[str, ...]) -> Iterator[str]:
    """The files of a folder; what begins with a dot belongs to an editor."""
    try:
        listed = os.listdir(folder)
    except OSError:
        return
    yield from (name for name in listed if name.endswith(endings) and not name.startswith("."))


def _read(path: Path) -> bytes | None:
    """The content, None where there is no such file; of anything but a file (a pipe, say) nothing is read."""
    try:
        status = path.stat()
        if stat.S_ISDIR(status.st_mode):
            return Unreadable(b"it is a folder")
        if not stat.S_ISREG(status.st_mode):
            return Unreadable(b"it is not a regular file")
        if status.st_size > MAX_FILE_BYTES:
            return Unreadable(f"it is larger than {MAX_FILE_BYTES // 1_000_000} MB".encode())
        return path.read_bytes()
    except FileNotFoundError:
        return Unreadable(b"the file it links to is not there") if path.is_symlink() else None
    except OSError as error:
        return Unreadable((error.strerror or "the system refuses").lower().encode())
