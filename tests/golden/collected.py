"""The number of tests that pytest collects, by folder of tests/: a file that is silently left out is noticed.

Two things are compared. Each function `test_…` that is written in a file of tests/ must be collected: this needs no
record, and finds a file with a wrong name, a class that pytest does not collect, and a name that is used twice. And
no folder may have fewer than in `recorded/collected/floors.json`:

- `functions`: functions of tests, whatever their parameters;
- `tests`: with their parameters;
- `cases`: rows of YAML tables, which a test may go through in a loop.

`python scripts/golden.py tests` raises the floors. Nothing fails if there are more, so a new test needs no recording;
a floor falls only with a record of the decision (scripts/golden_guard.py).
"""

import ast
import json
import re
import sys
from collections import Counter
from collections.abc import Iterator

from tests import ROOT
from tests.golden.golden import RECORDED
from tests.guarded import run_guarded

TESTS = ROOT / "tests"
FLOORS = RECORDED / "collected" / "floors.json"
ROW = re.compile(rb"(?m)^[^\s#\-%].*:(?=\s|$)")
Counts = dict[str, dict[str, int]]


def collected() -> list[str]:
    """Return the name of each test, those of `make soak` included, as pytest prints it."""
    call = [sys.executable, "-m", "pytest", "--collect-only", "-p", "no:cacheprovider", "tests"]
    done = run_guarded(call, cwd=ROOT, capture_output=True, text=True, timeout=900)
    assert done.returncode == 0, f"pytest can't collect the tests: {done.stdout[-3000:]}{done.stderr[-1000:]}"
    return [line for line in done.stdout.splitlines() if line.startswith("tests/") and "::" in line]


def counts(names: list[str]) -> Counts:
    """Return how many functions, tests and cases each folder has."""
    tests = Counter(map(_folder, names))
    functions = Counter(map(_folder, {name.partition("[")[0] for name in names}))
    cases = Counter[str]()
    for file in sorted(TESTS.rglob("*.yaml")):
        cases[_folder(str(file.relative_to(ROOT)))] += len(ROW.findall(file.read_bytes()))
    return {
        folder: {"functions": functions[folder], "tests": tests[folder]}
        | ({"cases": n} if (n := cases[folder]) else {})
        for folder in sorted(tests.keys() | cases.keys())
    }


def faults(names: list[str], floors: Counts) -> Iterator[str]:
    """Yield a sentence for each test that is not collected, and for each folder that has too few."""
    there = {name.partition("[")[0] for name in names}
    named = Counter(written())
    yield from (f"{name} is written and not collected" for name in named if name not in there)
    yield from (f"{name} is written {count} times, and collected once" for name, count in named.items() if count > 1)
    now = counts(names)
    for folder, least in floors.items():
        for kind, number in least.items():
            if (found := now.get(folder, {}).get(kind, 0)) < number:
                yield f"{folder} has {found} {kind}, and had {number}: python scripts/golden.py tests, with a record"


def written() -> Iterator[str]:
    """Yield the collected name of each function `test_…` in the files of tests/."""
    for file in sorted(TESTS.rglob("*.py")):
        if "projects" not in file.parts:
            yield from _written(ast.parse(file.read_bytes()).body, str(file.relative_to(ROOT)))


def _written(body: list[ast.stmt], name: str) -> Iterator[str]:
    for one in body:
        if isinstance(one, ast.FunctionDef | ast.AsyncFunctionDef) and one.name.startswith("test_"):
            yield f"{name}::{one.name}"
        elif isinstance(one, ast.ClassDef) and one.name.startswith("Test"):
            yield from _written(one.body, f"{name}::{one.name}")


def floors() -> Counts:
    """Return the least number of functions, tests and cases of each folder."""
    found: Counts = json.loads(FLOORS.read_text("utf-8"))
    return found


def raise_floors(names: list[str]) -> None:
    """Make the counts of now the floors."""
    FLOORS.parent.mkdir(parents=True, exist_ok=True)
    FLOORS.write_text(json.dumps(counts(names), indent=1) + "\n", "utf-8")


def _folder(name: str) -> str:
    """Return the folder of tests/ or tests/features/ that a file or test is in, `tests` if it is in none."""
    *folders, _ = name.partition("::")[0].split("/")
    return "/".join(folders[: 3 if "features" in folders else 2])
