"""What lint found in one project, and how its files are called where somebody stands."""

import os
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

from lumen.language.diagnostics import Diagnostic, Severity


@dataclass(frozen=True)
class Findings:
    """The findings of one project that are to be shown.

    `root` is its folder, empty where there is none; `elsewhere` counts what was found in files that nobody asked about,
    and `asked` are those that somebody did.
    """

    diagnostics: Sequence[Diagnostic]
    files: Mapping[str, bytes]
    root: str = ""
    asked: Collection[str] = ()
    elsewhere: int = 0
    names: dict[str, str] = field(default_factory=dict, compare=False, repr=False)

    def name(self, file: str) -> str:
        """How to call a file of the project from the working directory, so that a terminal finds it."""
        if file not in self.names:
            self.names[file] = _near(os.path.join(self.root, file)) if self.root else file
        return self.names[file]

    @cached_property
    def repository(self) -> str:
        """The folder of the repository around the project, else the working directory."""
        above = [Path(self.root or os.curdir).absolute(), *Path(self.root or os.curdir).absolute().parents]
        return str(next((folder for folder in above if (folder / ".git").exists()), Path.cwd()))

    def count(self, severity: Severity) -> int:
        return sum(d.severity is severity for d in self.diagnostics)


def _near(path: str) -> str:
    """The path as seen from here, or as it is where that is shorter."""
    try:
        seen = os.path.relpath(path)
    except (ValueError, OSError):
        return path
    return min(seen, os.path.abspath(path), key=len)
