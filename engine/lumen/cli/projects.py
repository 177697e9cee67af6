"""The project that a command shows, chosen by the same rule for every command."""

import sys
from pathlib import Path

from lumen.project.packaged import shipped_root
from lumen.project.running_project import is_substituted, running_project


def shown_project(path: str | None) -> Path:
    """Return the folder of a project; if none is here or above, the copy that `lumen run` plays, else the shipped one.

    In the latter two cases print a line on standard error. Raises UsageError if there is no such folder.
    """
    root = running_project(path)
    if is_substituted(path):
        which = "this is the shipped project" if root == shipped_root() else "this is the copy that `lumen run` plays"
        print(f"There is no lumen.yaml here or above: {which}, {root}.", file=sys.stderr)
    return root
