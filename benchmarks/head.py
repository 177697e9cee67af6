"""Measure how the head follows a face: print the table of docs/research.md, for a kinematic head and under physics.

    python benchmarks/head.py [--plot FILE.png] [--visitors 60]

At the start the head points 15 deg away from the face in yaw and 8 deg in pitch; an image is taken every `tick`, and
is known `latency` later. Overshoot is a fraction of that angle, settled is the time after which the head stays within
0.5 deg of the face, and rest is the remaining error at the end; each is the worse of yaw and pitch. For the walk a
person passes at 1.5 m with 0.5 m/s: the figure is the greatest distance of the face from the middle of the image, as
a fraction of half the image (1 is its edge). With --visitors, it measures visitors of all sizes on the stage under
physics, and prints the worst results; tests/fuzzy tests the same visitors.
"""

import argparse
import sys
from collections.abc import Callable, Iterator
from itertools import product
from math import degrees
from pathlib import Path

ROOT = Path(__file__).parents[1]
sys.path[:0] = [str(ROOT), str(ROOT / "engine")]

from tests.fuzzy import closed_loop, physical_loop  # noqa: E402
from tests.fuzzy.closed_loop import Run, off_by  # noqa: E402
from tests.fuzzy.nao import TOP  # noqa: E402
from tests.fuzzy.test_physics import cases, within_reach  # noqa: E402

import lumen  # noqa: E402
from lumen.language.projects import Project  # noqa: E402
from lumen.language.stories import Visitor  # noqa: E402
from lumen.motion.projection import Vector3, centring  # noqa: E402
from lumen.project.formats.plots import PlotAxis, PlotLine, PlotMark, PlotPanel, PlotSheet, draw  # noqa: E402

LATENCIES, TICKS, OFF = (0.0, 0.1, 0.2), (0.033, 0.1), (15.0, 8.0)
FACE: Vector3 = (1.5, 0.2, 0.5)
DURATION = 4.0
Loop = Callable[[float, float], tuple[Run, Run]]
"""A function of latency and tick; returns the run to a still face, relative to the goal, and that past a walker."""


def kinematic(project: Project) -> Loop:
    """Return the loop of a head without physics."""
    head, goal = project.controllers["head"], centring(FACE, TOP)

    def loop(latency: float, tick: float) -> tuple[Run, Run]:
        still = closed_loop.run(head, lambda now: FACE, off_by(FACE, *OFF), latency=latency, tick=tick)
        still.poses[:] = [(t, yaw - goal[0], pitch - goal[1]) for t, yaw, pitch in still.poses]
        start = centring(_passing(0.0), TOP)
        return still, closed_loop.run(head, _passing, start, latency=latency, tick=tick)

    return loop


def _passing(now: float) -> Vector3:
    return 1.5, -1.0 + 0.5 * now, 0.5


def physical(project: Project) -> Loop:
    """Return the loop of a head under physics."""

    def loop(latency: float, tick: float) -> tuple[Run, Run]:
        still = physical_loop.run(project, lambda now: Visitor(), OFF, latency=latency, tick=tick)
        walk = physical_loop.run(project, lambda now: Visitor(1.5, -1.0 + 0.5 * now), latency=latency, tick=tick)
        return still, walk

    return loop


def row(still: Run, walk: Run) -> Iterator[str]:
    """Yield the cells of a row: overshoot, settled, rest and walk."""
    yield f"{100 * max(still.overshoot(axis, 0.0) for axis in (0, 1)):.1f} %"
    yield f"{max(still.settled(axis, 0.0) for axis in (0, 1)):.2f} s"
    yield f"{degrees(max(abs(still.poses[-1][1 + axis]) for axis in (0, 1))):.2f} deg"
    yield f"{walk.farthest():.2f}"


def anybody(project: Project, count: int) -> str:
    """Return the worst results of visitors of all sizes, at any place, latency and tick."""
    runs = [
        physical_loop.run(project, lambda now, v=visitor: v, off, latency=latency, tick=tick, within=within_reach)
        for visitor, off, latency, tick in cases(11, count)
    ]
    both = [(run, axis) for run in runs for axis in (0, 1)]
    settled = max(run.settled(axis, 0.0) for run, axis in both)
    rest = degrees(max(abs(run.poses[-1][1 + axis]) for run, axis in both))
    beyond = 100 * max(run.overshoot(axis, 0.0) for run, axis in both)
    return f"{count} visitors: overshoot {beyond:.1f} %, settled {settled:.2f} s, rest {rest:.2f} deg at worst"


def sheet(found: dict[tuple[str, float, float], Run]) -> PlotSheet:
    """Return a panel for each loop and axis: the error of the head's direction by time, a line for each latency."""
    panels = []
    for (loop, tick), (axis, name) in product((("kinematic", 0.1), ("physics", 0.1)), enumerate(("yaw", "pitch"))):
        lines = []
        for style, latency in enumerate(LATENCIES):
            poses = found[loop, latency, tick].poses
            points = tuple(degrees(pose[1 + axis]) for pose in poses)
            lines.append(PlotLine(tuple(pose[0] for pose in poses), points, f"{1000 * latency:.0f} ms late", style))
        marks = (PlotMark(0.5, level=True), PlotMark(-0.5, level=True))
        y = PlotAxis("beside the face [deg]")
        panels.append(PlotPanel(f"{name}, {loop}", PlotAxis("time [s]", 0.0, DURATION), y, tuple(lines), marks))
    return PlotSheet("The head turns to a face, an image every 100 ms", tuple(panels), 2, "Level lines: 0.5 deg.")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--plot", type=Path, metavar="FILE", help="write the curves there, .png or .svg")
    parser.add_argument("--visitors", type=int, metavar="N", help="so many visitors of all sizes, under physics")
    options = parser.parse_args()
    project = lumen.load(ROOT)
    if options.visitors:
        print(anybody(project, options.visitors))
        return
    found: dict[tuple[str, float, float], Run] = {}
    print("| loop | latency | tick | overshoot | settled | rest | walk |\n| --- | --- | --- | --- | --- | --- | --- |")
    for (name, loop), latency, tick in product(
        (("kinematic", kinematic(project)), ("physics", physical(project))), LATENCIES, TICKS
    ):
        still, walk = loop(latency, tick)
        found[name, latency, tick] = still
        cells = (name, f"{1000 * latency:.0f} ms", f"{1000 * tick:.0f} ms", *row(still, walk))
        print(f"| {' | '.join(cells)} |", flush=True)
    if options.plot:
        options.plot.write_bytes(draw(sheet(found), options.plot.suffix))
        print(f"wrote {options.plot}")


if __name__ == "__main__":
    main()
