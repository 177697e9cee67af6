"""What workers get done: one motion played by many robots, in this process, in two, and on a cluster of this machine.

    python benchmarks/workers.py [--robots 24] [--motion photo]

Prints robots a second and the ratio to one process, with all starts: of processes, of the simulation, of models that
are compiled. Dask's scheduler and workers run here as well, so that more of them than cores bring nothing: what their
rows show is what the way there costs. Wall time, since somebody waits: the machine has to be quiet.
"""

import argparse
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))

from tests.workers.clusters import dask_cluster

import lumen
from lumen.app.lint.physics import play_case
from lumen.app.work.work_kit import WorkKit, models_in
from lumen.app.work.workers import Workers, cores, workers_of
from lumen.loading.files import read_files
from lumen.rules.physics.cases import cases

ROOT = Path(__file__).parents[1]


def played(workers: Workers, motion: str, robots: int) -> tuple[float, list[object]]:
    """How long the workers took [s], and what came of each robot, in order."""
    project = lumen.load(ROOT)
    found = cases(project)
    case = next(number for number, case in enumerate(found) if case.motion.name == motion)
    kit = WorkKit({"": read_files(ROOT)}, models_in(ROOT))
    began = time.perf_counter()
    tasks = [(case, robot, project.imperfections) for robot in range(robots)]
    outcomes = dict(workers.results(play_case, kit, tasks))
    return time.perf_counter() - began, [outcomes[number] for number in sorted(outcomes)]


def main() -> int:
    """1 where what came of it is not the same everywhere."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--robots", type=int, default=24)
    parser.add_argument("--motion", default="photo")
    options = parser.parse_args()
    print(f"{options.motion} with {options.robots} robots; {cores()} cores")
    alone, first = played(Workers(1), options.motion, options.robots)
    same = True

    def row(name: str, took: float, outcomes: list[object]) -> None:
        nonlocal same
        same &= outcomes == first
        told = "the same" if outcomes == first else "OTHER OUTCOMES"
        print(f"{name:<24} {options.robots / took:5.2f} robots/s  {alone / took:4.2f} x  {told}", flush=True)

    row("this process", alone, first)
    row("2 processes", *played(Workers(2), options.motion, options.robots))
    for count in (1, 2, 3):
        with tempfile.TemporaryDirectory() as folder, dask_cluster(Path(folder), count) as address:
            row(f"cluster, workers: {count}", *played(workers_of(address), options.motion, options.robots))
    return int(not same)


if __name__ == "__main__":
    sys.exit(main())
