"""Which files the engine and what comes with it are: what was worked out by others does not count."""

import hashlib
import os
import sys
from collections.abc import Iterator
from functools import cache
from pathlib import Path

from lumen.loading.packaged import PACKAGE, schema_folder, shipped_root


@cache
def engine() -> str:
    """A hash of which files the engine and what comes with it are: one that was edited is another engine."""
    digest = hashlib.sha256()
    for folder in (PACKAGE, schema_folder(), shipped_root() / "models"):
        for path, what, changed in sorted(listed(folder)):
            digest.update(os.fsencode(f"{folder} {path} {what} {changed}\n"))
    return digest.hexdigest()


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
