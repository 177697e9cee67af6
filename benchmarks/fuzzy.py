"""Measure the evaluation of the head controller by Lumen and by others, all in this run: CPU time, medians.

    python benchmarks/fuzzy.py

One evaluation computes both outputs. With 1,000 points each is within 1e-3 deg of the integral, which is measured too.
Lumen uses no lookup table: the exact evaluation is timed.
"""

import platform
import random
import sys
import warnings
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from statistics import median
from time import process_time
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lumen.fuzzy import Controller

HEAD = Path(__file__).parent.parent / "fuzzy" / "head.yaml"
POINTS, REPEATS, BATCH = 1000, 7, 100_000
Table = tuple[tuple[float, float], ...]
Inputs = Mapping[str, float]
One = Callable[[Inputs], Mapping[str, float]]

FACE_X: Table = ((0, 80), (160, 50), (320, 80))
FACE_Y: Table = ((0, 70), (120, 40), (240, 70))
ANGLE_X: Table = ((15, 10), (0, 10), (-15, 10))
ANGLE_Y: Table = ((7, 6), (0, 6), (-7, 6))


class ByHand:
    """One output of the head controller as written by hand: consequents are sampled once, then minimum and maximum."""

    def __init__(self, inputs: Table, outputs: Table, points: int = POINTS) -> None:
        end = outputs[0][0]
        self.y = -end + 2 * end * (np.arange(points) + 0.5) / points
        self.centres, self.sigmas = np.array(inputs).T
        self.terms = np.array([np.exp(-0.5 * ((self.y - c) / s) ** 2) for c, s in outputs])

    def one(self, x: float) -> float:
        """Return the output for one input."""
        degrees = np.exp(-0.5 * ((x - self.centres) / self.sigmas) ** 2)
        whole = np.minimum(degrees[:, None], self.terms).max(axis=0)
        return float(whole @ self.y / whole.sum())

    def many(self, xs: NDArray[np.float64], chunk: int = 64) -> NDArray[np.float64]:
        """Return the outputs, Shape (n,), for inputs of Shape (n,), computed in chunks."""
        return np.concatenate([self._chunk(xs[i : i + chunk]) for i in range(0, len(xs), chunk)])

    def _chunk(self, xs: NDArray[np.float64]) -> NDArray[np.float64]:
        degrees = np.exp(-0.5 * ((xs[:, None] - self.centres) / self.sigmas) ** 2)
        whole = np.minimum(degrees[:, 0, None], self.terms[0])
        for k in (1, 2):
            np.maximum(whole, np.minimum(degrees[:, k, None], self.terms[k]), out=whole)
        result: NDArray[np.float64] = (whole @ self.y) / whole.sum(axis=1)
        return result


def by_hand(points: int = POINTS) -> One:
    """Return the evaluation with NumPy by hand."""
    yaw, pitch = ByHand(FACE_X, ANGLE_X, points), ByHand(FACE_Y, ANGLE_Y, points)
    return lambda row: {"AngleX": yaw.one(row["FaceXLoc"]), "AngleY": pitch.one(row["FaceYLoc"])}


def fuzzylite(head: Controller, points: int) -> One:
    """Return an evaluation by pyfuzzylite, from Lumen's export."""
    import fuzzylite as fl

    from lumen.features.formats_fuzzy.fll import write_fll
    from lumen.project.formats.conversion_findings import dotted

    text = write_fll(head, dotted("head"))[0].replace("Centroid 1000", f"Centroid {points}")
    engine = fl.FllImporter().from_string(text)
    inputs = {variable.name: variable for variable in engine.input_variables}

    def one(row: Inputs) -> Mapping[str, float]:
        for name, value in row.items():
            inputs[name].value = value
        engine.process()
        return {variable.name: variable.value.item() for variable in engine.output_variables}

    return one


def scikit_fuzzy(head: Controller, points: int) -> One:
    """Return an evaluation by scikit-fuzzy, without its cache."""
    from skfuzzy import control, gaussmf

    made: dict[str, Any] = {}
    for side, kind in ((head.inputs, control.Antecedent), (head.outputs, control.Consequent)):
        for variable in side.values():
            made[variable.name] = new = kind(np.linspace(variable.minimum, variable.maximum, points), variable.name)
            for term in variable.terms.values():
                new[term.name] = gaussmf(new.universe, *term.parameters)
    rules = [
        control.Rule(
            made[rule.antecedent.variable][rule.antecedent.term],  # type: ignore[union-attr]
            made[rule.consequents[0].variable][rule.consequents[0].term],
        )
        for rule in head.rules
    ]
    simulation = control.ControlSystemSimulation(control.ControlSystem(rules), cache=False)

    def one(row: Inputs) -> Mapping[str, float]:
        for name, value in row.items():
            simulation.input[name] = value
        simulation.compute()
        return {name: float(simulation.output[name]) for name in head.outputs}

    return one


def simpful(head: Controller, points: int) -> One:
    """Return an evaluation by simpful."""
    from simpful import FuzzySystem, GaussianFuzzySet, LinguisticVariable

    system = FuzzySystem(show_banner=False, verbose=False)
    for variable in (*head.inputs.values(), *head.outputs.values()):
        sets = [GaussianFuzzySet(*term.parameters, term.name) for term in variable.terms.values()]
        universe = [variable.minimum, variable.maximum]
        system.add_linguistic_variable(variable.name, LinguisticVariable(sets, universe_of_discourse=universe))
    system.add_rules([
        f"IF ({r.antecedent.variable} IS {r.antecedent.term}) THEN "  # type: ignore[union-attr]
        f"({r.consequents[0].variable} IS {r.consequents[0].term})"
        for r in head.rules
    ])  # fmt: skip

    def one(row: Inputs) -> Mapping[str, float]:
        for name, value in row.items():
            system.set_variable(name, value)
        found: Mapping[str, float] = system.Mamdani_inference(list(head.outputs), subdivisions=points)
        return found

    return one


def rate(work: Callable[[], object], count: int) -> float:
    """Return the evaluations per second of CPU time: the median of several runs, after one to warm up."""
    work()
    times = []
    for _ in range(REPEATS):
        start = process_time()
        work()
        times.append(process_time() - start)
    return count / median(times)


def off(one: One, exact: One, rows: list[dict[str, float]]) -> float:
    """Return the greatest difference in either output [deg]."""
    pairs = [(one(row), exact(row)) for row in rows]
    return max(abs(said[name] - true[name]) for said, true in pairs for name in ("AngleX", "AngleY"))


def main() -> None:
    warnings.simplefilter("ignore")
    head = Controller.load(HEAD)
    draw = random.Random(2015)
    rows = [{"FaceXLoc": draw.uniform(0, 320), "FaceYLoc": draw.uniform(0, 240)} for _ in range(3000)]
    exact = by_hand(100_000)
    print(f"Python {platform.python_version()}, NumPy {np.__version__}, {platform.machine()}, {processor()}")
    print("\none evaluation, both outputs     per second   of pyfuzzylite   error [deg]")
    ways: list[tuple[str, One, int]] = [
        (f"pyfuzzylite, {POINTS} points", fuzzylite(head, POINTS), 300),
        ("pyfuzzylite, 100 points", fuzzylite(head, 100), 300),
        (f"scikit-fuzzy, {POINTS} points", scikit_fuzzy(head, POINTS), 30),
        (f"simpful, {POINTS} points", simpful(head, POINTS), 10),
        (f"NumPy by hand, {POINTS} points", by_hand(), 3000),
        ("Lumen", head.evaluate, 3000),
    ]
    base = 0.0
    for name, one, count in ways:
        speed = rate(lambda one=one, count=count: [one(row) for row in rows[:count]], count)  # type: ignore[misc]
        base = base or speed
        print(f"{name:32} {speed:10,.0f}   {speed / base:12.2f} x   {off(one, exact, rows[: min(count, 60)]):11.1e}")
    batches(head)


def batches(head: Controller) -> None:
    """Print the rates of batches, by hand and by Lumen."""
    yaw, pitch = ByHand(FACE_X, ANGLE_X), ByHand(FACE_Y, ANGLE_Y)
    columns = {"FaceXLoc": np.random.default_rng(1).uniform(0, 320, BATCH),
               "FaceYLoc": np.random.default_rng(2).uniform(0, 240, BATCH)}  # fmt: skip
    few = {name: xs[:5000] for name, xs in columns.items()}
    hand = rate(lambda: (yaw.many(few["FaceXLoc"]), pitch.many(few["FaceYLoc"])), 5000)
    ours = rate(partial(head.evaluate_batch, columns), BATCH)
    print("\nin a batch                       per second   of NumPy by hand")
    print(f"{'NumPy by hand, 5,000 rows':32} {hand:10,.0f}   {1:12.2f} x")
    print(f"{f'Lumen, {BATCH:,} rows':32} {ours:10,.0f}   {ours / hand:12.2f} x")


def processor() -> str:
    """Return the processor's name, if the system provides it."""
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
    except OSError:
        return platform.processor()
    return next((line.split(":")[1].strip() for line in lines if line.startswith("model name")), sys.platform)


if __name__ == "__main__":
    main()
