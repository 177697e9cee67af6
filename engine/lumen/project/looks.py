"""What was looked at beside the files of a project: what is kept of them holds as long as all of it is as it was."""

import os
import stat
import sys
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from lumen.project.kept_contents import SETTLED_NS
from lumen.project.packaged_models import package_file

Seen = tuple[str | int, ...]
"""Where a path leads, and what tells what is there from what was there before; the times come last [ns]."""


class Looks:
    """Each path with what was there, and each file of a Python package with where it was."""

    def __init__(self) -> None:
        self._began = time.time_ns()
        self._paths: dict[str, Seen] = {}
        self._packages: dict[str, str] = {}
        self._folders: dict[str, str] = {}
        """Where folders lead that were looked into."""

    def at(self, path: Path) -> str:
        """Say that what comes out depends on what is at this path: a file, which ones are in a folder, or nothing.

        Return where the path leads, empty for a name that no file can have.
        """
        name = os.path.abspath(path)
        if name not in self._paths:
            self._paths[name] = _seen(path, self._folders)
        return str(self._paths[name][0])

    def package_file(self, mjcf: str) -> Path | None:
        """The file of an installed package that `mjcf` names, None where there is none; it is looked at."""
        path = package_file(mjcf)
        self._packages[mjcf] = str(path or "")
        if path:
            self.at(path)
        return path

    def around(self) -> None:
        """Look at which time zones there are, and at the libraries that were imported."""
        from zoneinfo import TZPATH

        libraries = {name.partition(".")[0] for name in sys.modules} - sys.stdlib_module_names
        files = (getattr(sys.modules.get(name), "__file__", None) for name in sorted(libraries))
        for path in (*TZPATH, *filter(None, files)):
            self.at(Path(path))

    def settled(self) -> bool:
        """Whether the next change of each certainly shows in its times."""
        times = (int(time) for _, *status in self._paths.values() for time in status[-2:])
        return max(times, default=0) + SETTLED_NS < self._began

    def to_json(self) -> Mapping[str, Any]:
        return {"paths": self._paths, "packages": self._packages}


def unchanged(looks: Mapping[str, Mapping[str, Sequence[str | int]]]) -> bool:
    """Whether everything is as it was when these looks, as JSON, were taken."""
    folders: dict[str, str] = {}
    return all(list(_seen(Path(path), folders)) == list(seen) for path, seen in looks["paths"].items()) and all(
        str(package_file(mjcf) or "") == found for mjcf, found in looks["packages"].items()
    )


def _seen(path: Path, folders: dict[str, str]) -> Seen:
    """Of what can't be asked about, or is not there, only where it would be; `folders` remembers where they lead."""
    try:
        real = _real(path, folders)
        status = os.stat(real)
    except ValueError:  # a name with a NUL
        return ("",)
    except OSError:
        return (real,)
    return real, status.st_dev, status.st_ino, status.st_mode, status.st_size, status.st_mtime_ns, status.st_ctime_ns


def _real(path: Path, folders: dict[str, str]) -> str:
    """Return where a path leads. What is no link is looked at once, not each of the folders around it."""
    if not path.is_absolute() or ".." in path.parts or not path.name:
        return os.path.realpath(path)
    folder = str(path.parent)
    if folder not in folders:
        folders[folder] = os.path.realpath(folder)
    real = os.path.join(folders[folder], path.name)
    try:
        linked = stat.S_ISLNK(os.lstat(real).st_mode)
    except OSError:  # nothing is there
        return real
    return os.path.realpath(real) if linked else real
