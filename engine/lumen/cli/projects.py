"""Which project a command is about that shows something, or that asks a run: the same one for all of them."""

import sys
from pathlib import Path

from lumen.project.packaged import shipped_root
from lumen.project.running_project import is_substituted, running_project


def shown_project(path: str | None) -> Path:
    """Return the folder of a project; without one here or above, the copy that `lumen run` plays, else the shipped one.

    In the latter two cases print a line on standard error. Raises UsageError if there is no such folder.
    """
    root = running_project(path)
    if is_substituted(path):
        which = "this is the shipped project" if root == shipped_root() else "this is the copy that `lumen run` plays"
        print(f"There is no lumen.yaml here or above: {which}, {root}.", file=sys.stderr)
    return root
