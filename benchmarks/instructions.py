"""Compare the processor instructions that this checkout and another one execute, as Valgrind's cachegrind counts them.

    python benchmarks/instructions.py CHECKOUT [--rows WORD …]

Times differ by a factor of two between two runs on a machine that others use too; the number of instructions differs
by less than one percent, and until the first word by two, whatever else runs. It leaves out caches and disks; pairs.py
measures times. Both checkouts work on the other checkout's project, with this Python. A figure of an event
or of a saved file is the difference between a short and a long run; each other figure is the median of three runs.
"""

import argparse
import os
import re
import shutil
import sys
import tempfile
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from pathlib import Path
from statistics import median
from typing import NamedTuple

sys.path.insert(0, str(Path(__file__).parents[1]))

from all import speaking
from lint import EDITS, SETTLED_NS, edited
from pairs import with_project_of
from tests.guarded import PIPE, STDOUT, run_guarded

from lumen.project.project_folders import MAIN_FILE, PROJECT_FOLDERS

RUNS = 3
FEW, MANY = 1_000, 6_000
"""The events of a short and a long run, after as many as the short one to warm up."""
FEW_FILES, MANY_FILES = 5, 15
"""The same for saved files."""
WORK = """
import sys
from visit import tour
from statechart import regions, ring, sending

def messages(checked):
    import bus
    here, face, body = bus.connect("memory://"), "lumen.visual.face.detection", {"x": 160, "y": 120, "time": 12.5}
    here = bus.validated(here, bus.lumen.load(sys.argv[1])) if checked else here
    here.subscribe(face, lambda message: None)
    return lambda count: [here.publish(face, body) for _ in range(count)] and None

def saved():
    import lint
    root, number = lint.Path(sys.argv[1]), 0
    files = dict(lint.read_files(root))
    edited = "lumen.yaml", "behaviors/tour.yaml", "behaviors/stories/visitor.yaml", "motions/sing.yaml"
    def work(count):
        nonlocal number
        for name in (edited * count)[:count]:
            number += 1
            lint.check_files(root, {**files, name: files[name] + b"# %d" % number})
    return work
"""
"""The functions for the rows of events; both checkouts have the modules that they import."""
COUNTER = ("valgrind", "--tool=cachegrind", "--cache-sim=no", "--cachegrind-out-file=/dev/null")
COUNTED = re.compile(r"I\s+refs:\s+([\d,]+)")
HANG = 900
"""The time after which a run counts as hanging [s]."""


class Place(NamedTuple):
    """A checkout, a copy of the project, and the folder of a cache, which lint fills."""

    checkout: Path
    project: Path
    cache: Path


def main() -> int:
    """Print a line for each figure: the instructions in the other checkout and in this one, and their ratio."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("checkout", type=Path, help="the folder of the other checkout")
    parser.add_argument("--rows", nargs="*", default=[""], metavar="WORD", help="only rows that contain one of these")
    options = parser.parse_args()
    if not (options.checkout / "benchmarks/statechart.py").exists():
        parser.error(f"there is no benchmarks/statechart.py in {options.checkout}")
    if not shutil.which("valgrind"):
        parser.error("there is no `valgrind`: install the package of that name")
    print(f"{'':<42}{'there':>12}{'here':>12}{'ratio':>8}", flush=True)
    with tempfile.TemporaryDirectory() as name, ThreadPoolExecutor() as pool:
        folder, checkout = Path(name), options.checkout.resolve()
        here = with_project_of(checkout, folder / "here")
        places = [_place(folder / "1", checkout, checkout), _place(folder / "2", here, checkout)]
        time.sleep(SETTLED_NS / 1e9)  # lint does not keep the results of files that changed a moment ago
        for what, measure in ROWS.items():
            if any(word in what for word in options.rows):
                theirs, ours = pool.map(measure, places)
                print(f"{what:<42}{_shown(theirs):>12}{_shown(ours):>12}{ours / theirs:>8.3f}", flush=True)
    return 0


def _place(folder: Path, checkout: Path, of: Path) -> Place:
    """Fill a new folder with a copy of the project of the checkout `of`, for a run of `checkout`."""
    project = folder / "project"
    project.mkdir(parents=True)
    shutil.copy(of / MAIN_FILE, project)
    for name in PROJECT_FOLDERS:
        if (of / name).is_dir():
            shutil.copytree(of / name, project / name)
    return Place(checkout, project, folder / "cache")


def _shown(count: float) -> str:
    return f"{count / 1e6:,.1f} M" if count >= 1e6 else f"{count / 1e3:,.1f} k"


def _command(place: Place) -> float:
    return median(_count(place, "-m", "lumen", "--version") for _ in range(RUNS))


def _lint(place: Place) -> float:
    return median(_linted(place, kept=False) for _ in range(RUNS))


def _same_files(place: Place) -> float:
    _linted(place, kept=False)
    return median(_linted(place) for _ in range(RUNS))


def _one_changed(place: Place) -> float:
    """Return the instructions of a lint after a change in one file; the files are then as before."""
    name, before, value = EDITS[0]
    file = place.project / name
    content, counts = file.read_bytes(), []
    _linted(place, kept=False)
    for n in range(RUNS):
        file.write_bytes(edited(content, before, value, n))
        counts.append(_linted(place))
    file.write_bytes(content)
    return median(counts)


def _linted(place: Place, *, kept: bool = True) -> int:
    if not kept:
        shutil.rmtree(place.cache, ignore_errors=True)
    return _count(place, "-m", "lumen", "lint", str(place.project))


def _first_word(place: Place) -> float:
    """Return the instructions of a start with known files until the robot speaks, without those of child processes."""
    _spoken(place)
    return median(_spoken(place) for _ in range(RUNS))


def _spoken(place: Place) -> int:
    with tempfile.NamedTemporaryFile("r") as log:
        python = (*COUNTER, f"--log-file={log.name}", sys.executable)
        with speaking(python, place.project, "recording", _environment(place)):
            pass
        return _counted(log.read())


def _event(make: str, place: Place, few: int = FEW, many: int = MANY) -> float:
    """Return the instructions of one event of the work that the expression `make` returns."""

    def run(count: int) -> int:
        return _count(place, "-c", f"{WORK}\nwork = {make}; work({few}); work({count})", place.project)

    return (run(many) - run(few)) / (many - few)


def _count(place: Place, *words: str | Path) -> int:
    """Return the instructions of a Python process. Raises RuntimeError if it fails."""
    run = run_guarded(
        (*COUNTER, sys.executable, *words),
        env=_environment(place),
        stdout=PIPE,
        stderr=STDOUT,
        text=True,
        timeout=HANG,
    )
    if run.returncode:
        raise RuntimeError(f"`{' '.join(map(str, words))}` in {place.checkout}: {run.stdout.strip()[-300:]}")
    return _counted(run.stdout)


def _environment(place: Place) -> dict[str, str]:
    path = os.pathsep.join(str(place.checkout / part) for part in ("engine", "benchmarks", ""))
    changed = {"PYTHONPATH": path, "PYTHONHASHSEED": "0", "XDG_CACHE_HOME": str(place.cache)}
    return {name: text for name, text in {**os.environ, **changed}.items() if name != "PYTHONDONTWRITEBYTECODE"}


def _counted(printed: str) -> int:
    """Return the number of instructions that Valgrind printed. Raises RuntimeError if there is none."""
    if not (found := COUNTED.search(printed)):
        raise RuntimeError(f"Valgrind printed no count: {printed.strip()[-300:]}")
    return int(found[1].replace(",", ""))


ROWS: dict[str, Callable[[Place], float]] = {
    "`lumen --version`": _command,
    "`lumen lint`, nothing kept": _lint,
    "the same files again": _same_files,
    "one file changed": _one_changed,
    "a saved file, checked by the same process": partial(_event, "saved()", few=FEW_FILES, many=MANY_FILES),
    "the first word of the recording robot": _first_word,
    "an event of a ring of 15 states": partial(_event, "sending(ring(15))"),
    "an event of three levels, two regions": partial(_event, "sending(regions())"),
    "an event of visits to the tour": partial(_event, "tour()"),
    "a message in this process, unchecked": partial(_event, "messages(False)"),
    "the same, checked": partial(_event, "messages(True)"),
}


if __name__ == "__main__":
    sys.exit(main())
