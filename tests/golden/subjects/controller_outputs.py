"""The outputs of each controller of the frozen projects on a grid of its inputs, as hexadecimal floats.

Where the processor's arithmetic is another than that of the recording (`texts.arithmetic`), its last bits may differ:
there an output may be as far as `TOLERANCE` from the recorded one.
"""

from itertools import product
from pathlib import Path

import lumen
from lumen.fuzzy import Controller
from tests.golden.golden import PROJECTS, RECORDED
from tests.golden.texts import ARITHMETIC, arithmetic, snapped, write

SUITE = "test"
STEPS = 12
"""The number of intervals in the range of each input; one more point is outside at either end."""
TOLERANCE = 1e-9
NUMBER = r"-?0x[0-9a-f.]+p[+-]\d+"


def record(folder: Path) -> None:
    """Write a file for each controller."""
    for root in sorted(PROJECTS.iterdir()):
        for name in sorted(lumen.load(root).controllers):
            lines = outputs(Controller.load(root / "fuzzy" / f"{name}.yaml"))
            if arithmetic() != ARITHMETIC:
                lines = snapped(lines, RECORDED / "controller_outputs" / root.name / f"{name}.txt", TOLERANCE, NUMBER)
            write(folder / root.name / f"{name}.txt", lines)


def outputs(controller: Controller) -> list[str]:
    """Return a line for each point of the grid: the inputs, then the outputs by one evaluation and by a batch."""
    axes = [
        [each.minimum + (each.maximum - each.minimum) * step / STEPS for step in range(-1, STEPS + 2)]
        for each in controller.inputs.values()
    ]
    points = [dict(zip(controller.inputs, point, strict=True)) for point in product(*axes)]
    batch = controller.evaluate_batch({name: [point[name] for point in points] for name in controller.inputs})
    lines = [" ".join([*controller.inputs, "->", *controller.outputs, "batch"])]
    for number, point in enumerate(points):
        single = controller.evaluate(point)
        found = [value.hex() for value in single.values()] + [float(batch[name][number]).hex() for name in single]
        lines.append(" ".join([*(f"{value:g}" for value in point.values()), "->", *found]))
    return lines
