"""The output of `lumen export` for the frozen projects: charts, diagrams, controllers and AsyncAPI."""

import json
import shutil
from pathlib import Path

from tests.golden.command_line import lumen, workplace
from tests.golden.found import write_json
from tests.golden.golden import PROJECTS, SHIPPED

SUITE = "test"
FORMATS = {"scxml": "scxml", "xstate": "json", "mermaid": "mmd", "dot": "dot"}
"""The formats of a behaviour, and the ending of such a file."""


def record(folder: Path) -> None:
    """Write each export as a file, and the findings about the parts it leaves out in `findings.json`."""
    found = {}
    with workplace() as work:
        for name in SHIPPED:
            shutil.copytree(PROJECTS / name, work / name)
        for project, kind, name, ending in exports():
            file = folder / f"{project}.{name or kind}.{ending}"
            words = ("export", kind, *([name] if name else []), "--project", project, "-o", "made", "--format", "json")
            outcome = lumen(work, *words)
            assert (work / "made").is_file(), outcome
            file.write_bytes((work / "made").read_bytes())
            (work / "made").unlink()
            diagnostics = json.loads(outcome.err)["diagnostics"] if outcome.err.startswith("{") else outcome.err
            found[file.name] = {"exit": outcome.code, "printed": outcome.out, "findings": diagnostics}
    write_json(folder / "findings.json", found)


def exports() -> list[tuple[str, str, str, str]]:
    """Return project, format, name and ending of each export."""
    rows = []
    for project in (PROJECTS / name for name in SHIPPED):
        behaviors = sorted(file.stem for file in project.glob("behaviors/*.yaml"))
        rows += [(project.name, kind, name, ending) for name in behaviors for kind, ending in FORMATS.items()]
        rows += [(project.name, "fll", file.stem, "fll") for file in sorted(project.glob("fuzzy/*.yaml"))]
        rows.append((project.name, "asyncapi", "", "json"))
    return rows
