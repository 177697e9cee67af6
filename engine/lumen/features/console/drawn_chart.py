"""The running behaviour's chart as boxes and lines, from which a page draws it and marks active states."""

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from lumen.errors import UsageError
from lumen.language.machines import MachineDefinition, State
from lumen.lint import check_files
from lumen.project.files import read_files
from lumen.run.diagrams.placing import PADDING, ROW_HEIGHT, TITLE_HEIGHT, PlacedBox, place
from lumen.run.diagrams.svg_writer import arrow_lines
from lumen.run.diagrams.views import overview
from lumen.run.one_robot import one_robot
from lumen.run.replaying.journals import KeptBundles


def chart_of(root: Path, robot: str, hash: str) -> dict[str, Any]:
    """Return the behaviour's chart from the bundle `hash`, or from the saved files if that bundle was not kept.

    All lengths are in px. `boxes` are in drawing order, outer ones first. Raises UsageError if the bundle was not kept
    and the saved files have errors.
    """
    robot = one_robot(root, robot)
    project = KeptBundles(root, robot).load(hash) or check_files(root, read_files(root, robot))[0]
    if project is None:
        raise UsageError("the files that run were not kept, and the saved files have errors")
    return drawn(project.machine)


def drawn(machine: MachineDefinition) -> dict[str, Any]:
    """Return the boxes and lines of a behaviour's chart, with its `width` and `height` [px]."""
    placement = place(overview(machine))
    return {
        "behavior": machine.id,
        "width": round(placement.size.width, 1),
        "height": round(placement.size.height, 1),
        "boxes": [one for box in placement.boxes for one in _boxes(box, machine.states, 0)],
        "lines": list(arrow_lines(placement.arrows)),
    }


def _boxes(placed: PlacedBox, states: Mapping[str, State], depth: int) -> Iterator[dict[str, Any]]:
    """Yield a box and the boxes inside it, each with its state's `path` and `name` and its texts' positions [px]."""
    box, (x, y), (width, height) = placed.box, placed.corner, placed.size
    baseline = y + TITLE_HEIGHT - 1
    state = states.get(box.id)
    yield {
        "path": box.id,
        "name": state.name if state else box.title,
        "title": box.title,
        "rows": [{"text": row, "y": round(baseline + 2 + n * ROW_HEIGHT, 1)} for n, row in enumerate(box.rows, 1)],
        "depth": depth,
        "leaf": not placed.within,
        "final": box.final,
        "first": box.first,
        **{key: round(value, 1) for key, value in (("x", x), ("y", y), ("width", width), ("height", height))},
        "text": [round(x + PADDING, 1), round(baseline, 1)],
    }
    for inner in placed.within:
        yield from _boxes(inner, states, depth + 1)
