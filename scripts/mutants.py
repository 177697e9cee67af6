"""Measure how much the tests notice: change the engine in one place, and see whether a test fails.

    python scripts/mutants.py --record FOLDER                         # which tests execute which lines; an hour or more
    python scripts/mutants.py --compare BEFORE AFTER                  # what only the first recording executes
    python scripts/mutants.py --draw 400 --seed 1 --recording FOLDER  # try mutants; --help lists more options

First a statement of engine/lumen is drawn, then a kind of change that applies to it, then one such change. The mutant
runs the tests that execute its lines, cheapest first, until one fails: those of `make test`, then the rest, so one run
measures both suites. For a line that is executed at import, these are the tests that execute a function which uses what
it defines, or a function of the same file. A mutant has 60 s of processor time in all processes. It hangs, and counts
as killed, if a test takes many times as long as in the recording. Results are kept in .cache/mutants/SEED.jsonl, from
which `--resume` continues. Mutants that behave like the original are listed in scripts/equivalent_mutants.yaml, each
with a proof.
"""

import argparse
import ast
import json
import os
import subprocess
import sys
import tempfile
from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from functools import cached_property
from pathlib import Path
from queue import SimpleQueue
from random import Random
from typing import Any, NamedTuple

import yaml
from mutation.changes import Change, Source, Statement
from mutation.trial import ROOT, Copy, Ended

ENGINE = "engine/lumen"
KEPT = ROOT / ".cache/mutants"
EQUIVALENT = Path(__file__).with_name("equivalent_mutants.yaml")
BUDGET = 60.0
"""Processor time of a mutant [s]."""
IDLE = 600.0
"""The wall time after which a hanging test is ended [s]."""
HANGS = (10.0, 10.0)
"""A test hangs if it takes longer than this [s] and this many times as long as in the recording."""
OVERHEAD = 0.005
"""The time that pytest itself adds to each test [s]."""
BATCHES = (0.5, 4.0, 20.0)
"""Recorded times after which the next tests are collected [s]: most mutants die before."""
CLASSES = (0.05, 0.5, 5.0)
"""Tests of about the same cost run file by file, as they share fixtures [s]."""
COLUMNS = ("mutants", "test", "all", "hangs", "not executed", "survived", "equivalent", "% test", "% all")


class Mutant(NamedTuple):
    """A change of a statement in a file; `before` and `after` show it.

    `line` is the first line of the change, `source` the text of the statement's first line, and `content` the whole
    changed file.
    """

    file: str
    statement: Statement
    change: Change
    line: int
    source: str
    before: str
    after: str
    content: bytes

    @property
    def name(self) -> str:
        """Return the place of the change, and its text before and after."""
        return f"{self.file}:{self.line} {self.before} -> {self.after}"

    def described(self) -> dict[str, Any]:
        """Return the row to store; `file`, `in` and `change` identify it among the equivalent mutants."""
        inner = self.file.removeprefix(f"{ENGINE}/")
        folder = inner.partition("/")[0] if "/" in inner else "."
        change = f"{self.before} -> {self.after}"
        return {"name": self.name, "folder": folder, "file": self.file, "in": self.source, "change": change}


class Engine:
    """The sources of the engine, and where its functions use each name."""

    def __init__(self, root: Path = ROOT) -> None:
        files = sorted((root / ENGINE).rglob("*.py"))
        self.sources = {file.relative_to(root).as_posix(): Source(file) for file in files}

    @cached_property
    def uses(self) -> Mapping[str, Mapping[str, set[int]]]:
        """Return by name the files and lines of functions that use it."""
        found: dict[str, dict[str, set[int]]] = defaultdict(lambda: defaultdict(set))
        for file, source in self.sources.items():
            for function in _functions(source.tree):
                for node in ast.walk(ast.Module(function.body, [])):
                    name = getattr(node, "id", None) or getattr(node, "attr", None)
                    if isinstance(node, ast.Name | ast.Attribute) and name:
                        found[name][file].add(node.lineno)
        return found

    def draw(self, count: int, seed: int, only: str = "") -> list[Mutant]:
        """Draw different mutants; the same seed draws the same ones, and a greater `count` only adds to them."""
        random = Random(seed)
        statements = [
            (file, statement)
            for file, source in self.sources.items()
            if file.startswith(f"{ENGINE}/{only}")
            for statement in source.statements
        ]
        found: dict[str, Mutant] = {}
        for _ in range(100 * count):
            if len(found) == count:
                break
            file, statement = random.choice(statements)
            if mutant := self._mutant(random, file, statement):
                found.setdefault(mutant.name, mutant)
        return list(found.values())

    def _mutant(self, random: Random, file: str, statement: Statement) -> Mutant | None:
        source, kinds = self.sources[file], defaultdict(list)
        for change in source.changes(statement.node):
            kinds[change.kind].append(change)
        if not kinds:
            return None
        change = random.choice(kinds[random.choice(sorted(kinds))])
        content = source.changed(change)
        return content and Mutant(
            file,
            statement,
            change,
            source.lines(change)[0],
            source.first_line(statement.node),
            *source.shown(change),
            content,
        )

    def tests(self, mutant: Mutant, located: Any) -> set[str]:
        """Return the tests that execute the changed code of a mutant."""
        file, source = mutant.file, self.sources[mutant.file]
        if not mutant.statement.binds:
            lines = source.lines(mutant.change)
            return located.executing(file, lines) or located.executing(file, mutant.statement.header)
        uses: dict[str, set[int]] = defaultdict(set)
        for name in mutant.statement.binds:
            for where, lines in self.uses.get(name, {}).items():
                uses[where] |= lines
        uses[file] |= {line for function in _functions(source.tree) for line in _body(function)}
        return set().union(*(located.executing(where, lines) for where, lines in uses.items()))


def _functions(tree: ast.Module) -> list[ast.FunctionDef | ast.AsyncFunctionDef]:
    return [node for node in ast.walk(tree) if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef)]


def _body(function: ast.FunctionDef | ast.AsyncFunctionDef) -> range:
    return range(function.body[0].lineno, (function.end_lineno or 0) + 1)


def batches(tests: Iterable[str], cpu: Mapping[str, float]) -> list[list[str]]:
    """Return tests in the order in which they run: the cheapest first, and no more than the budget may allow."""
    cost = {test: cpu.get(test, 1.0) + OVERHEAD for test in tests}
    ordered = sorted(cost, key=lambda t: (sum(cost[t] > limit for limit in CLASSES), t.partition("::")[0], cost[t], t))
    found: dict[int, list[str]] = defaultdict(list)
    total = 0.0
    for test in ordered:
        if total > 2 * BUDGET:
            break
        total += cost[test]
        found[sum(total > limit for limit in BATCHES)].append(test)
    return list(found.values())


def outcome(ended: Ended, cpu: Mapping[str, float]) -> str:
    """Return the outcome of a mutant by how its tests ended; it survives a time-out without a slow test."""
    usual = cpu.get(ended.test, 1.0)
    if ended.how == "failed":
        return "killed"
    slow = ended.own > max(HANGS[0], HANGS[1] * usual)
    return "hangs" if ended.how in ("time", "memory") or (ended.how == "processor time" and slow) else "survived"


class Trials:
    """Tries mutants in copies of the repository, one at a time in each copy."""

    def __init__(
        self, copies: Sequence[Copy], located: Any, engine: Engine, suites: Mapping[str, set[str] | None]
    ) -> None:
        self._copies: SimpleQueue[Copy] = SimpleQueue()
        for copy in copies:
            self._copies.put(copy)
        self._workers = ThreadPoolExecutor(len(copies))
        self._located, self._engine, self._suites = located, engine, suites
        self._cpu = located.recording.cpu

    def end(self) -> None:
        """Start no more trials."""
        self._workers.shutdown(cancel_futures=True)

    def settle(self, mutants: Sequence[Mutant], kept: Path) -> None:
        """Try mutants, and try those again that were killed by a test that fails on the original engine."""
        if self._failing({min(self._cpu, key=lambda test: self._cpu[test])}):
            raise RuntimeError("the cheapest test fails in a copy of the repository, without any mutant")
        left, unfit = [mutant for mutant in mutants if mutant.name not in results(kept)], set[str]()
        while True:
            self._all(left, kept, frozenset(unfit))
            killed = {name: r["test"] for name, r in results(kept).items() if r["outcome"] == "killed"}
            unfit |= self._failing({test for test in killed.values() if test})
            left = [mutant for mutant in mutants if killed.get(mutant.name) in unfit]
            if not left:
                break
            print(f"{len(left)} mutants again without {', '.join(sorted(unfit))}", flush=True)

    def _all(self, mutants: Iterable[Mutant], kept: Path, but: frozenset[str]) -> None:
        with kept.open("a") as file:
            for done in as_completed([self._workers.submit(self._one, mutant, but) for mutant in mutants]):
                result = done.result()
                print(json.dumps(result), file=file, flush=True)
                print(f"{result['outcome']:12} {result['cpu']:5.1f} s  {result['name']}  {result['test']}", flush=True)

    def _failing(self, tests: Iterable[str]) -> set[str]:
        copy = self._copies.get()
        ended = copy.run([sorted(tests)], 60 * BUDGET, IDLE, every=True)
        self._copies.put(copy)
        if ended.how != ("failed" if ended.failed else "passed"):
            raise RuntimeError(f"the tests do not end on the engine as it is ({ended.how}): {ended.test}")
        return set(ended.failed)

    def _one(self, mutant: Mutant, but: frozenset[str]) -> dict[str, Any]:
        tests = self._engine.tests(mutant, self._located) - but
        result = mutant.described() | {"outcome": "not executed", "suite": "", "test": "", "cpu": 0.0}
        copy = self._copies.get()
        try:
            for suite, members in self._suites.items():
                chosen = tests if members is None else tests & members
                tests = tests - chosen
                if chosen and result["outcome"] in ("not executed", "survived") and result["cpu"] < BUDGET:
                    change = (mutant.file, mutant.content)
                    ended = copy.run(batches(chosen, self._cpu), BUDGET - result["cpu"], IDLE, change)
                    result |= {"outcome": outcome(ended, self._cpu), "suite": suite, "test": ended.test}
                    result["cpu"] = round(result["cpu"] + ended.cpu, 2)
        finally:
            self._copies.put(copy)
        return result


def table(results: Iterable[Mapping[str, Any]]) -> str:
    """Return a row for each folder: the numbers killed by `make test`, by all tests, and by neither."""
    folders: dict[str, list[Mapping[str, Any]]] = defaultdict(list)
    for result in results:
        folders[result["folder"]].append(result)
        folders["~"].append(result)
    rows = [("", *COLUMNS)]
    for folder, found in sorted(folders.items()):
        killed = [r for r in found if r["outcome"] in ("killed", "hangs")]
        same = [r for r in found if r.get("equivalent") and r not in killed]
        counts = [
            sum(r["outcome"] == what and r not in same for r in found) for what in ("hangs", "not executed", "survived")
        ]
        first, base = sum(r["suite"] == "test" for r in killed), len(found) - len(same) or 1
        numbers = (
            len(found),
            first,
            len(killed),
            *counts,
            len(same),
            f"{100 * first / base:.1f}",
            f"{100 * len(killed) / base:.1f}",
        )
        rows.append(("together" if folder == "~" else folder, *map(str, numbers)))
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    return "\n".join("  ".join([row[0].ljust(widths[0]), *map(str.rjust, row[1:], widths[1:])]) for row in rows)


def record(folder: Path, suite: str, workers: int, words: Sequence[str]) -> int:
    """Run a suite, or the tests selected by `words`, and record the lines that each test executes."""
    from mutation.executed import prepare, read

    engine = ROOT / ENGINE
    environment = {**os.environ, **prepare(folder.resolve(), engine), "PYTHONPATH": str(ROOT / "scripts")}
    command = [
        sys.executable,
        "-m",
        "pytest",
        "-p",
        "mutation.executed",
        "-n",
        str(workers),
        "--dist",
        "loadgroup",
    ]
    chosen = ["-m", "not soak", *(["--suite", suite] if (ROOT / "tests/suites.py").exists() else [])]
    command += ["--no-loadscope-reorder", *(words or chosen)]
    code = subprocess.run(command, cwd=ROOT, env=environment, check=False).returncode
    recording = read(folder, engine)
    print(f"{len(recording.cpu):,} tests, {sum(recording.cpu.values()):,.0f} s of processor time")
    return code


def compare(before: Path, after: Path) -> int:
    """Print what the first recording executes and the second does not; return 1 if there is any."""
    from mutation.executed import compare, read

    lost = compare(read(before), read(after))
    for file, (lines, branches) in lost.items():
        print(file)
        print(
            f"    lines {', '.join(map(str, lines))}" if lines else "",
            *(f"    {a} -> {b}" for a, b in branches),
            sep="\n",
        )
    print(
        f"{sum(len(f.lines) for f in lost.values())} lines and {sum(len(f.branches) for f in lost.values())} branches"
    )
    return int(bool(lost))


def draw(options: argparse.Namespace) -> int:
    """Draw mutants, try those without a stored result, and print the survivors and the table."""
    from mutation.executed import Located, read

    engine = Engine()
    mutants = engine.draw(options.draw, options.seed, options.only)
    kept = options.results or ROOT / f".cache/mutants/{options.seed}.jsonl"
    kept.parent.mkdir(parents=True, exist_ok=True)
    if not options.resume:
        kept.write_text("")
    located = Located(
        read(options.recording), {file: source.content.decode() for file, source in engine.sources.items()}
    )
    with tempfile.TemporaryDirectory(prefix="mutants-") as folder:
        copies = [Copy(Path(folder, str(number))) for number in range(options.workers)]
        first = {"test": first_tests(options.first)}
        trials = Trials(copies, located, engine, first if options.suite == "test" else first | {"rest": None})
        try:
            trials.settle(mutants, kept)
        finally:
            trials.end()
    found = [result for name, result in results(kept).items() if name in {mutant.name for mutant in mutants}]
    equivalent = {(e["file"], e["in"], e["change"]) for e in yaml.safe_load(EQUIVALENT.read_text()) or ()}
    for result in found:
        result["equivalent"] = (result["file"], result["in"], result["change"]) in equivalent
        if result["outcome"] in ("survived", "not executed") and not result["equivalent"]:
            print(f"{result['outcome']}: {result['name']}")
    print(table(found))
    return 0


def results(kept: Path) -> dict[str, dict[str, Any]]:
    """Return the results in a file by mutant; the latest of each."""
    lines = kept.read_text().splitlines() if kept.exists() else []
    return {result["name"]: result for result in map(json.loads, lines)}


def first_tests(file: Path | None) -> set[str] | None:
    """Return the tests of `make test`, from a file or as pytest collects them; None if there is only one suite."""
    if file:
        return set(file.read_text().split("\n"))
    if not (ROOT / "tests/suites.py").exists():
        return None
    command = [sys.executable, "-m", "pytest", "--collect-only", "--suite", "test"]
    listed = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True).stdout
    return {line for line in listed.splitlines() if "::" in line}


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    what = parser.add_mutually_exclusive_group(required=True)
    what.add_argument("--record", type=Path, metavar="FOLDER")
    what.add_argument("--compare", type=Path, nargs=2, metavar=("BEFORE", "AFTER"))
    what.add_argument("--draw", type=int, metavar="COUNT")
    parser.add_argument("--suite", choices=("test", "all"), default="all", help="which suite to record, or to try")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--recording", type=Path, default=ROOT / ".cache/recording", metavar="FOLDER")
    parser.add_argument("--first", type=Path, metavar="FILE", help="the ids of the tests of `make test`, one a line")
    parser.add_argument("--only", default="", metavar="FOLDER", help="draw from this folder of engine/lumen only")
    parser.add_argument("--workers", type=int, default=2, help="how many mutants or tests run at once (default: 2)")
    parser.add_argument("--results", type=Path, metavar="FILE")
    parser.add_argument("--resume", action="store_true", help="keep the results that are there")
    parser.add_argument("words", nargs="*", help="for --record, after `--`: what pytest is to run instead of the suite")
    options = parser.parse_args()
    if options.workers < (0 if options.record else 1):
        parser.error("--workers is at least 1; with --record, 0 runs all tests in one process")
    if options.record and options.record.exists():
        parser.error(f"{options.record} exists: a recording is written into a new folder")
    needed = [] if options.record else options.compare or [options.recording]
    if missing := [str(folder) for folder in needed if not any(folder.glob("*.pickle"))]:
        parser.error(f"there is no recording {', '.join(missing)}: `--record FOLDER` writes one")
    if options.record:
        return record(options.record, options.suite, options.workers, options.words)
    return compare(*options.compare) if options.compare else draw(options)


if __name__ == "__main__":
    sys.exit(main())
