"""Identify the software: by the state of its files on this machine, or by its code's content on any machine."""

import hashlib
import os
import sys
from collections.abc import Iterator
from contextlib import suppress
from functools import cache
from importlib.util import find_spec
from pathlib import Path

from lumen.distributions import Distribution, distributions, metadata_folders
from lumen.project.packaged import PACKAGE, schema_folder, shipped_root


@cache
def engine() -> str:
    """Return a hash of the state of the files of the engine and its data. Rewriting a file changes the hash.

    A distribution with features counts as a part of the engine.
    """
    return files_hash(PACKAGE, schema_folder(), shipped_root() / "models")


def files_hash(*folders: Path) -> str:
    """Return a hash of the names, sizes and times of the files in these folders, without reading a file.

    The files of distributions with features are part of it.
    """
    digest = hashlib.sha256()
    others = distributions()
    for folder in (*folders, *(place for each in others for place in _places(each))):
        digest.update(os.fsencode(f"{folder}\n{sorted(listed(folder))}"))
    if others:  # one of them may need a distribution that is installed later
        digest.update(os.fsencode(repr((others, *metadata_folders()))))
    return digest.hexdigest()


@cache
def code_hash(*names: str) -> str:
    """Return a hash of the code of these packages or modules of Lumen, the same on each machine.

    Names, versions and files of distributions with features are part of it. Raises ModuleNotFoundError if there is no
    package or module of that name, so that a moved package is not left out silently.
    """
    digest = hashlib.sha256()
    for file in sorted({file for name in names for file in _sources(name)}):
        digest.update(hashlib.sha256(file.relative_to(PACKAGE).as_posix().encode() + file.read_bytes()).digest())
    for other in distributions():
        digest.update(repr(other).encode())
        for place in _places(other):
            for path in sorted(path for path, _, _ in listed(place)):
                digest.update(hashlib.sha256(f"{place.name}/{path}".encode() + (place / path).read_bytes()).digest())
    return digest.hexdigest()


def _places(distribution: Distribution) -> Iterator[Path]:
    """Iterate over the folders and single files that hold the packages of a distribution."""
    for package in distribution.packages:
        if found := find_spec(package):
            yield from map(Path, found.submodule_search_locations or [str(found.origin)])


def _sources(name: str) -> Iterator[Path]:
    if (found := find_spec(name)) is None:
        raise ModuleNotFoundError(name)
    if found.submodule_search_locations is None:
        yield Path(str(found.origin))
    for folder in found.submodule_search_locations or ():
        yield from Path(folder).rglob("*.py")


def surroundings(root: Path) -> str:
    """Return a text that identifies the rest of what a project's results depend on: its path, the engine and Python."""
    about = (str(root), os.path.abspath(root), engine(), sys.version, sys.path, os.environ.get("PYTHONTZPATH"))
    return repr(about)


def listed(folder: Path) -> Iterator[tuple[str, str, int]]:
    """Yield each file below a folder: its relative path, a text about its state, and when its entry changed [ns].

    The text holds the file's size, when it was written, and the target if it is a link, so an exact copy has the same
    text. `__pycache__` and folders that can't be listed are skipped. If `folder` is a file, its path is `.`.
    """
    if folder.is_file():
        status = folder.stat()
        yield ".", f"{status.st_size} {status.st_mtime_ns} ", status.st_ctime_ns
    ahead = [(str(folder), "")]
    while ahead:
        here, within = ahead.pop()
        entries = list[os.DirEntry[str]]()
        with suppress(OSError):
            entries += os.scandir(here)
        for entry in entries:
            if entry.is_dir(follow_symlinks=False):
                if entry.name != "__pycache__":
                    ahead.append((entry.path, f"{within}{entry.name}/"))
            else:
                status = entry.stat(follow_symlinks=False)
                leads = os.readlink(entry.path) if entry.is_symlink() else ""
                yield within + entry.name, f"{status.st_size} {status.st_mtime_ns} {leads}", status.st_ctime_ns
