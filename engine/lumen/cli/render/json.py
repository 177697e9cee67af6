"""One JSON object with all diagnostics, for other programs."""

import json
from collections.abc import Mapping, Sequence

from lumen.language.diagnostics import Diagnostic


def render(diagnostics: Sequence[Diagnostic], files: Mapping[str, bytes], *, coloured: bool = False) -> str:
    """`{"diagnostics": […], "files": N}`; lines and columns from 1, files relative to the project."""
    found = {"diagnostics": [d.to_json() for d in diagnostics], "files": len(files)}
    return json.dumps(found, indent=2)
