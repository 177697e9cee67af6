"""One JSON object with all diagnostics, for other programs."""

import json
from collections.abc import Sequence

from lumen.run.linting.findings import Findings


def render(found: Sequence[Findings], *, coloured: bool = False) -> str:
    """Return `{"diagnostics": […], "files": N}`; lines and columns count from 1, files are relative to the project.

    If there are several projects, each diagnostic also has its `project`: the folder.
    """
    several = len(found) > 1
    rows = [
        ({"project": each.root} if several else {}) | diagnostic.to_json()
        for each in found
        for diagnostic in each.diagnostics
    ]
    return json.dumps({"diagnostics": rows, "files": sum(len(each.files) for each in found)}, indent=2)
