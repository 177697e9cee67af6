"""A snapshot of each state of the tour, resumed by a start on newer files, in which a state has another name."""

import json
from pathlib import Path

import lumen
from tests.golden.adapters import continued, reloaded_to
from tests.golden.golden import PROJECTS
from tests.golden.kept import bundles, journals
from tests.golden.subjects.resumed_snapshots import AWAY, SNAPSHOTS
from tests.golden.texts import write

SUITE = "test"


def record(folder: Path) -> None:
    """Write a paragraph for each state."""
    old, new = lumen.load(PROJECTS / "tour"), reloaded_to(journals()["reload"][-1], bundles(""))
    lines = []
    for line in SNAPSHOTS.read_text("utf-8").splitlines():
        frozen = json.loads(line)
        lines += [str(frozen.pop("state")), *continued(old, new, frozen, AWAY, 0.5)]
    write(folder / "states.txt", lines)
