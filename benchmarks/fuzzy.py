"""How fast the head controller is evaluated: ours, against the same sums written by hand in NumPy. CPU time, medians.

    python benchmarks/fuzzy.py

One evaluation gives both outputs, each the centroid of 1,000 points, which is within 1e-3 deg of the exact integral.
"""

import platform
import random
import sys
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from statistics import median
from time import process_time

import numpy as np
from numpy.typing import NDArray

from lumen.fuzzy import Controller

HEAD = Path(__file__).parent.parent / "fuzzy" / "head.yaml"
POINTS, REPEATS, BATCH = 1000, 7, 100_000
Table = tuple[tuple[float, float], ...]
Inputs = Mapping[str, float]

FACE_X: Table = ((0, 80), (160, 50), (320, 80))
FACE_Y: Table = ((0, 70), (120, 40), (240, 70))
ANGLE_X: Table = ((15, 10), (0, 10), (-15, 10))
ANGLE_Y: Table = ((7, 6), (0, 6), (-7, 6))


class ByHand:
    """One output of the head controller as a person would write it: consequents sampled once, then minimum, maximum."""

    def __init__(self, inputs: Table, outputs: Table, points: int = POINTS) -> None:
        end = outputs[0][0]
        self.y = -end + 2 * end * (np.arange(points) + 0.5) / points
        self.centres, self.sigmas = np.array(inputs).T
        self.terms = np.array([np.exp(-0.5 * ((self.y - c) / s) ** 2) for c, s in outputs])

    def one(self, x: float) -> float:
        degrees = np.exp(-0.5 * ((x - self.centres) / self.sigmas) ** 2)
        whole = np.minimum(degrees[:, None], self.terms).max(axis=0)
        return float(whole @ self.y / whole.sum())

    def many(self, xs: NDArray[np.float64], chunk: int = 64) -> NDArray[np.float64]:
        return np.concatenate([self._chunk(xs[i : i + chunk]) for i in range(0, len(xs), chunk)])

    def _chunk(self, xs: NDArray[np.float64]) -> NDArray[np.float64]:
        degrees = np.exp(-0.5 * ((xs[:, None] - self.centres) / self.sigmas) ** 2)
        whole = np.minimum(degrees[:, 0, None], self.terms[0])
        for k in (1, 2):
            np.maximum(whole, np.minimum(degrees[:, k, None], self.terms[k]), out=whole)
        result: NDArray[np.float64] = (whole @ self.y) / whole.sum(axis=1)
        return result


def rate(work: Callable[[], object], count: int) -> float:
    """Evaluations per second of CPU time: the median of several runs, after one to warm up."""
    work()
    times = []
    for _ in range(REPEATS):
        start = process_time()
        work()
        times.append(process_time() - start)
    return count / median(times)


def main() -> None:
    head = Controller.load(HEAD)
    yaw, pitch = ByHand(FACE_X, ANGLE_X), ByHand(FACE_Y, ANGLE_Y)
    draw = random.Random(2015)
    rows = [{"FaceXLoc": draw.uniform(0, 320), "FaceYLoc": draw.uniform(0, 240)} for _ in range(3000)]
    columns = {"FaceXLoc": np.random.default_rng(1).uniform(0, 320, BATCH),
               "FaceYLoc": np.random.default_rng(2).uniform(0, 240, BATCH)}  # fmt: skip

    def both(row: Inputs) -> tuple[float, float]:
        return yaw.one(row["FaceXLoc"]), pitch.one(row["FaceYLoc"])

    few = {name: xs[:5000] for name, xs in columns.items()}
    results = [
        ("one evaluation, NumPy by hand", rate(lambda: [both(row) for row in rows], len(rows)), 0),
        ("one evaluation, Lumen", rate(lambda: [head.evaluate(row) for row in rows], len(rows)), 0),
        ("batch, NumPy by hand", rate(lambda: (yaw.many(few["FaceXLoc"]), pitch.many(few["FaceYLoc"])), 5000), 2),
        (f"batch of {BATCH:,}, Lumen", rate(partial(head.evaluate_batch, columns), BATCH), 2),
    ]
    print(f"Python {platform.python_version()}, NumPy {np.__version__}, {platform.machine()}, {processor()}")
    print(f"difference to NumPy by hand: {difference(head, yaw, pitch, rows):.1e} deg; "
          f"to 100,000 points: {error(head, rows[:100]):.1e} deg")  # fmt: skip
    for name, value, base in results:
        print(f"{name:32} {value / 1e3:9.1f} k/s   {value / results[base][1]:6.2f} x by hand")


def difference(head: Controller, yaw: ByHand, pitch: ByHand, rows: list[dict[str, float]]) -> float:
    """The largest difference [deg] between ours and the sums by hand."""
    found = 0.0
    for row in rows:
        said = head.evaluate(row)
        found = max(
            found, abs(said["AngleX"] - yaw.one(row["FaceXLoc"])), abs(said["AngleY"] - pitch.one(row["FaceYLoc"]))
        )
    return found


def error(head: Controller, rows: list[dict[str, float]]) -> float:
    """The largest difference [deg] to the integral, taken with a hundred times as many points."""
    return difference(head, ByHand(FACE_X, ANGLE_X, 100_000), ByHand(FACE_Y, ANGLE_Y, 100_000), rows)


def processor() -> str:
    """The processor's name, where the system tells it."""
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
    except OSError:
        return platform.processor()
    return next((line.split(":")[1].strip() for line in lines if line.startswith("model name")), sys.platform)


if __name__ == "__main__":
    main()
