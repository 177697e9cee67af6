"""Record the paths that a result depends on besides a project's files, to reuse it only while they are unchanged."""

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
"""The target of a path and the status of the file there; its last two elements are times [ns]."""


class Looks:
    """The paths and files of Python packages that a check examined, each with its state at that time."""

    def __init__(self) -> None:
        self._began = time.time_ns()
        self._paths: dict[str, Seen] = {}
        self._packages: dict[str, str] = {}
        self._folders: dict[str, str] = {}
        """The resolved paths of folders that were looked into."""

    def at(self, path: str | Path) -> str:
        """Record that the result depends on this path: on the file there, the entries of a folder, or its absence.

        Return the resolved path, empty for a name that no file can have.
        """
        name = os.path.abspath(path)
        if name not in self._paths:
            self._paths[name] = _seen(path, self._folders)
        return str(self._paths[name][0])

    def package_file(self, mjcf: str) -> Path | None:
        """Return the file of an installed package that `mjcf` names, or None; record that the result depends on it."""
        path = package_file(mjcf)
        self._packages[mjcf] = str(path or "")
        if path:
            self.at(path)
        return path

    def around(self) -> None:
        """Record the time zones and the imported libraries as dependencies."""
        from zoneinfo import TZPATH

        libraries = {name.partition(".")[0] for name in sys.modules} - sys.stdlib_module_names
        files = (getattr(sys.modules.get(name), "__file__", None) for name in sorted(libraries))
        for path in (*TZPATH, *filter(None, files)):
            self.at(path)

    def settled(self) -> bool:
        """Return True if the next change of any recorded path will certainly alter its times."""
        times = (int(time) for _, *status in self._paths.values() for time in status[-2:])
        return max(times, default=0) + SETTLED_NS < self._began

    def to_json(self) -> Mapping[str, Any]:
        return {"paths": self._paths, "packages": self._packages}


def unchanged(looks: Mapping[str, Mapping[str, Sequence[str | int]]]) -> bool:
    """Return True if no path has changed since `looks`, the result of `Looks.to_json`, was recorded."""
    folders: dict[str, str] = {}
    return all(list(_seen(path, folders)) == list(seen) for path, seen in looks["paths"].items()) and all(
        str(package_file(mjcf) or "") == found for mjcf, found in looks["packages"].items()
    )


def _seen(path: str | Path, folders: dict[str, str]) -> Seen:
    """Return the state of a path; only its target if nothing is there. `folders` caches resolved folders."""
    try:
        real = _real(path, folders)
        status = os.stat(real)
    except ValueError:  # a name with a NUL
        return ("",)
    except OSError:
        return (real,)
    return real, status.st_dev, status.st_ino, status.st_mode, status.st_size, status.st_mtime_ns, status.st_ctime_ns


def _real(path: str | Path, folders: dict[str, str]) -> str:
    """Return the resolved path. A path that is not a link is checked with one call instead of one for each folder."""
    text = str(path)
    folder, name = os.path.split(text)
    if not os.path.isabs(text) or ".." in text.split(os.sep) or not name:
        return os.path.realpath(text)
    if folder not in folders:
        folders[folder] = os.path.realpath(folder)
    real = os.path.join(folders[folder], name)
    try:
        linked = stat.S_ISLNK(os.lstat(real).st_mode)
    except OSError:  # nothing is there
        return real
    return os.path.realpath(real) if linked else real
