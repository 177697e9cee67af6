"""Compare the speeds of this checkout with those of another one: benchmarks/all.py, run in both alternately.

    python benchmarks/pairs.py CHECKOUT [--pairs 9] [--rows WORD …]

Each checkout runs its own scripts and its own engine, both with this Python. The project that they measure, the tour,
is that of the other checkout: a tour that has grown doesn't count as a slower engine. A pair runs one row in both
checkouts, one after the other, and the next pair in the other order, so that a load which changes slowly meets both.

For each figure of a row: the medians, the median of the pairs' ratios (above 1: this checkout is slower), and the
middle half of the same ratios between successive runs of the other checkout, which is what chance does on this
machine (A/A). `worse` means that the ratio is above 1.05 and above that middle half.
"""

import argparse
import os
import re
import shutil
import sys
import tempfile
from collections.abc import Iterator, Sequence
from itertools import pairwise
from pathlib import Path
from statistics import median, quantiles
from typing import NamedTuple

sys.path.insert(0, str(Path(__file__).parents[1]))

from all import ROWS, Row
from tests.guarded import run_guarded

from lumen.project.project_folders import MAIN_FILE, PROJECT_FOLDERS

ROOT = Path(__file__).parents[1]
NUMBER = re.compile(r"\d[\d,]*(?:\.\d+)?")
CLEAR = 1.05
HANG = 900
"""The time after which a row counts as hanging [s]."""


class NotMeasuredError(Exception):
    """A row that a checkout could not measure; the text says why."""


class Figure(NamedTuple):
    """A figure of a row in this checkout and in the other one, in the order of the pairs."""

    ours: Sequence[float]
    theirs: Sequence[float]

    def ratios(self, more: bool) -> list[float]:
        """Return for each pair how much slower this checkout is; `more`: a larger figure is better."""
        return [_slower(ours, theirs, more) for ours, theirs in zip(self.ours, self.theirs, strict=True)]

    def chance(self, more: bool) -> tuple[float, float]:
        """Return the quartiles of the ratios between successive runs of the other checkout."""
        low, _, high = quantiles([_slower(after, before, more) for before, after in pairwise(self.theirs)], n=4)
        return low, high


def main() -> int:
    """Print a line for each figure; return 1 if one is worse."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("checkout", type=Path, help="the folder of the other checkout")
    parser.add_argument("--pairs", type=int, default=9, help="at least 3")
    parser.add_argument("--rows", nargs="*", default=[""], metavar="WORD", help="only rows that contain one of these")
    options = parser.parse_args()
    if options.pairs < 3:
        parser.error("--pairs must be at least 3: the spread needs two successive ratios")
    if not (options.checkout / "benchmarks/all.py").exists():
        parser.error(f"there is no benchmarks/all.py in {options.checkout}")
    for word in options.rows:
        if not any(word in row.what for row in ROWS):
            parser.error(f"no row contains {word!r}; the rows are:\n" + "\n".join(row.what for row in ROWS))
    worse, checkout = 0, options.checkout.resolve()
    print(f"{'':<58}{'there':>10}{'here':>10}{'ratio':>8}  A/A", flush=True)
    with tempfile.TemporaryDirectory() as folder:
        here = with_project_of(checkout, Path(folder) / "here")
        for row in ROWS:
            # `make quick` runs other tests in each checkout.
            if any(word in row.what for word in options.rows) and "make quick" not in row.what:
                for line in _compared(row, here, checkout, options.pairs):
                    worse += line.endswith("worse")
                    print(line, flush=True)
    return bool(worse)


def with_project_of(checkout: Path, folder: Path) -> Path:
    """Fill a new folder with this checkout, mostly as links, and the project of the other; return the folder."""
    folder.mkdir()
    project = {MAIN_FILE, *PROJECT_FOLDERS}
    for path in ROOT.iterdir():
        if path.name not in (*project, ".lumen", "benchmarks"):
            (folder / path.name).symlink_to(path)
    # Python puts the real folder of a script on its path: in a linked folder, scripts would import those of ROOT.
    shutil.copytree(ROOT / "benchmarks", folder / "benchmarks")
    for name in filter(lambda name: (checkout / name).exists(), project):
        if name == MAIN_FILE:
            shutil.copy(checkout / name, folder)
        else:
            shutil.copytree(checkout / name, folder / name)
    # The engine's own schemas are in the same folder as the project's messages.
    shutil.copytree(ROOT / "schemas", folder / "schemas", ignore=shutil.ignore_patterns("messages"), dirs_exist_ok=True)
    return folder


def _compared(row: Row, here: Path, checkout: Path, pairs: int) -> Iterator[str]:
    runs: dict[Path, list[list[float]]] = {here: [], checkout: []}
    try:
        for pair in range(pairs):
            for place in (here, checkout) if pair % 2 else (checkout, here):
                runs[place].append(_measured(row, place))
    except NotMeasuredError as why:
        yield f"{row.what:<58}{why}"
        return
    columns = zip(zip(*runs[here], strict=True), zip(*runs[checkout], strict=True), strict=False)
    for number, (ours, theirs) in enumerate(columns):
        if number not in row.ours:
            continue
        name = row.what if number == 0 else f"    number {number + 1} of its row"
        yield f"{name:<58}{_line(Figure(ours, theirs), row.more)}"


def _line(figure: Figure, more: bool) -> str:
    line = f"{median(figure.theirs):>10g}{median(figure.ours):>10g}"
    if not all((*figure.ours, *figure.theirs)):
        return line
    ratio, (low, high) = median(figure.ratios(more)), figure.chance(more)
    return f"{line}{ratio:>8.2f}  {low:.2f} to {high:.2f}{'  worse' if ratio > max(high, CLEAR) else ''}"


def _slower(here: float, there: float, more: bool) -> float:
    return there / here if more else here / there


def _measured(row: Row, checkout: Path) -> list[float]:
    """Return the figures of a row, as one process in that checkout prints them. Raises NotMeasuredError."""
    environment = {**os.environ, "PYTHONPATH": f"{checkout / 'engine'}{os.pathsep}{checkout}"}
    environment.pop("PYTHONDONTWRITEBYTECODE", None)
    command = [sys.executable, "benchmarks/all.py", "--rows", row.what]
    run = run_guarded(command, cwd=checkout, env=environment, capture_output=True, text=True, timeout=HANG)
    found = [line for line in run.stdout.splitlines() if line.startswith(row.what)]
    if run.returncode or not found:
        raise NotMeasuredError(f"not measured in {checkout.name}: {run.stderr.strip()[-200:]}")
    # The first row of that name: `--rows` prints each that contains the words.
    text = found[0].removeprefix(row.what).lstrip()[len(row.wanted) :]
    if "not measured" in text:
        raise NotMeasuredError(f"not measured in {checkout.name}: {text.partition('not measured: ')[2]}")
    return [float(number.replace(",", "")) for number in NUMBER.findall(text)]


if __name__ == "__main__":
    sys.exit(main())
