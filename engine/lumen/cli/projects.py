"""Which project a verb that only shows something is about: the shipped one where there is no other, and it says so."""

import sys
from pathlib import Path

from lumen.loading.packaged import find_project, project_above


def shown_project(path: str | None) -> Path:
    """The folder of a project; on standard error a word where it is the shipped one because there is no other."""
    root = find_project(path)
    if path is None and project_above(Path.cwd()) is None:
        print(f"There is no lumen.yaml here or above: this is the shipped project, {root}.", file=sys.stderr)
    return root
