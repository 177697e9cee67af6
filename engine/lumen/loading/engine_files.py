"""Which software this is: by the state of its files on this machine, or by the content of its code on any machine."""

import hashlib
import os
import sys
from collections.abc import Iterator
from functools import cache
from importlib.util import find_spec
from pathlib import Path

from lumen.loading.packaged import PACKAGE, schema_folder, shipped_root


@cache
def engine() -> str:
    """Return a hash of the state of the engine's files and of what comes with it; a file written again changes it."""
    return files_hash(PACKAGE, schema_folder(), shipped_root() / "models")


def files_hash(*folders: Path) -> str:
    """Return a hash of which files are in these folders, and when and how long they were written; reads no file."""
    digest = hashlib.sha256()
    for folder in folders:
        for path, what, changed in sorted(listed(folder)):
            digest.update(os.fsencode(f"{folder} {path} {what} {changed}\n"))
    return digest.hexdigest()


@cache
def code_hash(*names: str) -> str:
    """Return a hash of the code of these packages or modules of Lumen, the same on each machine.

    Raises ModuleNotFoundError if there is none of that name: a moved package must not be left out silently.
    """
    digest = hashlib.sha256()
    for file in sorted({file for name in names for file in _sources(name)}):
        digest.update(hashlib.sha256(file.relative_to(PACKAGE).as_posix().encode() + file.read_bytes()).digest())
    return digest.hexdigest()


def _sources(name: str) -> Iterator[Path]:
    if (found := find_spec(name)) is None:
        raise ModuleNotFoundError(name)
    if found.submodule_search_locations is None:
        yield Path(str(found.origin))
    for folder in found.submodule_search_locations or ():
        yield from Path(folder).rglob("*.py")


def surroundings(root: Path) -> str:
    """What all that is worked out of a project depends on beside its files: where it lies, the engine and Python."""
    about = (str(root), os.path.abspath(root), engine(), sys.version, sys.path, os.environ.get("PYTHONTZPATH"))
    return repr(about)


def listed(folder: Path) -> Iterator[tuple[str, str, int]]:
    """The files below a folder: path from there, what is the same in a copy of it elsewhere, and when it was put there.

    What is the same is its size, when it was written, and where it leads if it is a link. The last is in [ns]; a folder
    that can't be listed has no files.
    """
    yield from _below(str(folder), "")


def _below(folder: str, within: str) -> Iterator[tuple[str, str, int]]:
    try:
        entries = list(os.scandir(folder))
    except OSError:
        return
    for entry in entries:
        if entry.is_dir(follow_symlinks=False):
            if entry.name != "__pycache__":
                yield from _below(entry.path, f"{within}{entry.name}/")
        else:
            status = entry.stat(follow_symlinks=False)
            leads = os.readlink(entry.path) if entry.is_symlink() else ""
            yield within + entry.name, f"{status.st_size} {status.st_mtime_ns} {leads}", status.st_ctime_ns
