"""Choose the project that a command shows, by the same rule for every command."""

import sys
from pathlib import Path

from lumen.project.packaged import shipped_root
from lumen.project.running_project import is_substituted, running_project


def shown_project(path: str | None) -> Path:
    """Return the folder of a project: `path`, by default the working directory or its nearest parent with lumen.yaml.

    Without one, return the copy of the shipped project that `lumen run` plays, or else the shipped project
    itself, and print that on standard error. Raises UsageError if `path` is not a folder.
    """
    root = running_project(path)
    if is_substituted(path):
        which = "this is the shipped project" if root == shipped_root() else "this is the copy that `lumen run` plays"
        print(f"There is no lumen.yaml here or above: {which}, {root}.", file=sys.stderr)
    return root
