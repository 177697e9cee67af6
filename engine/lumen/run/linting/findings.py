"""Findings of lint in one project, and the names of its files as seen from the working directory."""

import os
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

from lumen.language.diagnostics import Diagnostic, Severity


@dataclass(frozen=True)
class Findings:
    """The findings of one project that will be shown."""

    diagnostics: Sequence[Diagnostic]
    files: Mapping[str, bytes]
    """The contents of the project's files."""
    root: str = ""
    """The folder of the project; empty if there is no project."""
    asked: Collection[str] = ()
    """Files that the user named; empty for the whole project."""
    elsewhere: int = 0
    """The number of findings in other files, which are not shown."""
    names: dict[str, str] = field(default_factory=dict, compare=False, repr=False)
    """The results of `name`, by file."""

    def name(self, file: str) -> str:
        """Return the path of a project's file relative to the working directory, so that a terminal can open it."""
        if file not in self.names:
            self.names[file] = _near(os.path.join(self.root, file)) if self.root else file
        return self.names[file]

    @cached_property
    def repository(self) -> str:
        """The folder of the repository around the project, else the working directory."""
        above = [Path(self.root or os.curdir).absolute(), *Path(self.root or os.curdir).absolute().parents]
        return str(next((folder for folder in above if (folder / ".git").exists()), Path.cwd()))

    def count(self, severity: Severity) -> int:
        """Return how many findings have a severity."""
        return sum(d.severity is severity for d in self.diagnostics)


def _near(path: str) -> str:
    """Return the path relative to the working directory, or the absolute one if that is shorter."""
    try:
        seen = os.path.relpath(path)
    except (ValueError, OSError):
        return path
    return min(seen, os.path.abspath(path), key=len)
