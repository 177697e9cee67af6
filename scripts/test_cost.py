"""Print the cost of the tests in processor time: by folder, the twenty most expensive, and the whole run.

    python scripts/test_cost.py [--suite test|rest|all] [--markdown] [--report FILE] [-- PYTEST_ARGUMENTS]

It uses processor time, since wall times differ by a factor of three between machines and loads. A test's share is the
time of its worker, and of processes for which the worker waited, during the test; shared costs (collecting, the one
browser, the one broker) are the line below the folders.
"""

import argparse
import os
import sys
import tempfile
from collections import defaultdict
from pathlib import Path
from xml.etree import ElementTree

from measured import Measured, measured

DEAREST = 20


def main() -> int:
    """Run the tests, and print the tables; return pytest's exit code."""
    parser = argparse.ArgumentParser(description="Print what the tests cost in processor time.")
    parser.add_argument("--suite", choices=("test", "rest", "all"), default="test")
    parser.add_argument("--workers", default=str(os.cpu_count() or 1), help="of pytest-xdist; 0 for none")
    parser.add_argument("--markdown", action="store_true", help="print tables for a document")
    parser.add_argument("--report", type=Path, metavar="FILE", help="keep what each test costs, as JUnit's XML")
    parser.add_argument("arguments", nargs="*", help="for pytest")
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        report = given.report or Path(folder) / "report.xml"
        how = ["-n", given.workers, "--dist", "loadgroup", "--no-loadscope-reorder", "--suite", given.suite]
        beside = ["sh", str(Path(__file__).with_name("with_packages.sh"))]
        command = [
            *beside,
            sys.executable,
            "-m",
            "pytest",
            *how,
            "-m",
            "not soak",
            f"--junitxml={report}",
            *given.arguments,
        ]
        # As in the Makefile: otherwise each of the processes that tests start would compile everything again.
        environment = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
        run = measured(command, environment)
        if not report.exists():
            return run.code
        costs = read(report)
    print()
    for line in (markdown if given.markdown else plain)(folders(costs), run):
        print(line)
    print(f"\nThe {DEAREST} dearest tests:\n")
    for name, cost in sorted(costs.items(), key=lambda item: -item[1])[:DEAREST]:
        print(f"{cost:8.1f} s  {name}")
    return run.code


def read(report: Path) -> dict[str, float]:
    """Return the processor time of each test in a report of pytest [s]."""
    found: dict[str, float] = {}
    for case in ElementTree.parse(report).iter("testcase"):
        for entry in case.iter("property"):
            if entry.get("name") == "cpu_time":
                found[f"{case.get('classname')}::{case.get('name')}"] = float(entry.get("value") or 0)
    return found


def folders(costs: dict[str, float]) -> dict[str, tuple[int, float]]:
    """Return the number of tests and their cost [s] by folder, the most expensive first."""
    found: dict[str, list[float]] = defaultdict(list)
    for name, cost in costs.items():
        modules = name.partition("::")[0].split(".")
        found["/".join(modules[1 : 3 if modules[1] == "features" else 2])].append(cost)
    return dict(sorted(((name, (len(each), sum(each))) for name, each in found.items()), key=lambda row: -row[1][1]))


def plain(rows: dict[str, tuple[int, float]], run: Measured) -> list[str]:
    """Return the lines of a table for the terminal."""
    shared = run.cpu - sum(cost for _, cost in rows.values())
    lines = [f"{cost:8.1f} s  {count:6d} tests  {name}" for name, (count, cost) in rows.items()]
    count = sum(count for count, _ in rows.values())
    return [
        *lines,
        f"{shared:8.1f} s  shared: collecting, browser, broker",
        f"{run.cpu:8.1f} s  {count:6d} tests: {run}",
    ]


def markdown(rows: dict[str, tuple[int, float]], run: Measured) -> list[str]:
    """Return the lines of a table in Markdown."""
    shared = run.cpu - sum(cost for _, cost in rows.values())
    lines = [f"| {name} | {count} | {cost:.1f} |" for name, (count, cost) in rows.items()]
    head = ["| folder | tests | processor time [s] |", "| --- | ---: | ---: |"]
    count = sum(count for count, _ in rows.values())
    return [*head, *lines, f"| shared | | {shared:.1f} |", f"| all | {count} | {run.cpu:.1f} |", "", f"{run}."]


if __name__ == "__main__":
    sys.exit(main())
