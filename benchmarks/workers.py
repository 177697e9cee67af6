"""Measure the speed of workers: many robots play one motion, in this process, in two, and on a cluster of this machine.

    python benchmarks/workers.py [--robots 24] [--motion goodbye]

It prints robots per second and the ratio to one process, including all starts: of processes, of the simulation, and of
compiled models. Dask's scheduler and workers run on this machine too, so more workers than cores have no benefit: their
rows show the overhead of the cluster. Both figures are wall time, so the machine must be quiet. Processor time is valid
on a busy machine as well; it is that of all processes, including their starts.
"""

import argparse
import sys
import tempfile
import time
from contextlib import ExitStack
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))

from tests.cpu_time import cpu_time
from tests.workers.clusters import dask_cluster

import lumen
from lumen.features.simulation.settings import Imperfections
from lumen.features.simulation.trials.cases import cases
from lumen.features.simulation.trials.playing import play_case
from lumen.project.files import read_files
from lumen.run.workers.tasks import WorkKit, models_in
from lumen.run.workers.workers import Workers, cores, workers_of

ROOT = Path(__file__).parents[1]


def played(workers: Workers, motion: str, robots: int) -> tuple[float, list[object]]:
    """Return the duration [s], and the outcome of each robot, in order."""
    project = lumen.load(ROOT)
    found = cases(project)
    case = next(number for number, case in enumerate(found) if case.motion.name == motion)
    kit = WorkKit({"": read_files(ROOT)}, models_in(ROOT))
    began = time.perf_counter()
    tasks = [(case, robot, project.section(Imperfections)) for robot in range(robots)]
    outcomes = dict(workers.results(play_case, kit, tasks))
    return time.perf_counter() - began, [outcomes[number] for number in sorted(outcomes)]


def main() -> int:
    """Print the table; return 1 if the outcomes differ."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--robots", type=int, default=24)
    parser.add_argument("--motion", default="goodbye")
    options = parser.parse_args()
    print(f"{options.motion} with {options.robots} robots; {cores()} cores")
    rows: list[tuple[float, list[object]]] = []

    def row(name: str, cluster: int, workers: int = 1) -> None:
        before = cpu_time()
        with ExitStack() as opened:
            if cluster:
                folder = opened.enter_context(tempfile.TemporaryDirectory())
                address = opened.enter_context(dask_cluster(Path(folder), cluster))
            who = workers_of(address) if cluster else Workers(workers)
            took, outcomes = played(who, options.motion, options.robots)
        rows.append((took, outcomes))
        (alone, first), cpu = rows[0], cpu_time() - before
        told = "the same" if outcomes == first else "OTHER OUTCOMES"
        speed = f"{options.robots / took:5.2f} robots/s  {alone / took:4.2f} x  {cpu:5.1f} s of processor time"
        print(f"{name:<24} {speed}  {told}", flush=True)

    row("this process", 0)
    for count in dict.fromkeys((2, max(2, cores()))):
        row(f"{count} processes", 0, count)
    for count in (1, 2, 3):
        row(f"cluster, workers: {count}", count)
    return int(any(outcomes != rows[0][1] for _, outcomes in rows))


if __name__ == "__main__":
    sys.exit(main())
