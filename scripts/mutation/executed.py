"""Records which tests execute which lines of the engine, including child processes, for mutants.py.

The pytest plug-in takes the traced arcs after each test from coverage.py's tracer. A child process is traced by
coverage.py itself; the context in its data is the test during which it was started.
"""

import difflib
import os
import pickle
import re
import sqlite3
import uuid
from collections import defaultdict
from collections.abc import Generator, Iterable, Iterator
from contextlib import closing
from pathlib import Path
from typing import NamedTuple

import coverage
import pytest
from coverage.numbits import nums_to_numbits

ENGINE = "engine/lumen"
OUT, CONTEXT = "LUMEN_TEST_RECORDING", "LUMEN_TEST_CONTEXT"
SETTINGS = """[run]
branch = True
source = {source}
parallel = True
data_file = {folder}/child
sigterm = True
context = ${{LUMEN_TEST_CONTEXT-none}}
disable_warnings = no-data-collected,module-not-measured,no-ctracer
"""

ARCS = (
    "select context, path, fromno, tono from arc join file on file.id = file_id join context on context.id = context_id"
)

Arc = tuple[int, int]
Lines = dict[str, dict[bytes, set[int]]]
"""By file: a set of lines (coverage.py's bits) → the tests that execute exactly these."""


class Tracer:
    """Collects the lines of each test and the arcs of all of them."""

    def __init__(self, folder: str) -> None:
        self._folder = folder
        self._coverage = coverage.Coverage(config_file=f"{folder}/rc", data_file=None)
        self._coverage.start()
        self._arcs: dict[str, set[int]] = defaultdict(set)
        self._tests: dict[str, dict[str, bytes]] = defaultdict(dict)
        self._cpu: dict[str, float] = {}

    def _take(self, test: str = "") -> None:
        """Collect what was executed since the last call, for the given test."""
        for file, traced in list(self._coverage._collector.data.items()):  # type: ignore[union-attr]
            if packed := set(traced):
                traced.clear()
                self._arcs[file] |= packed
                if test:
                    self._tests[test][file] = nums_to_numbits(_lines(map(unpacked, packed)))

    @pytest.hookimpl(wrapper=True, tryfirst=True)
    def pytest_runtest_protocol(self, item: pytest.Item) -> Generator[None, bool, bool]:
        """Record what a test executes, and its processor time."""
        self._take()
        os.environ[CONTEXT] = item.nodeid
        began = sum(os.times()[:4])
        result = yield
        self._cpu[item.nodeid] = sum(os.times()[:4]) - began
        self._take(item.nodeid)
        return result

    def pytest_sessionfinish(self) -> None:
        """Write the recording of this process."""
        self._coverage.stop()
        self._take()
        content = pickle.dumps((dict(self._arcs), dict(self._tests), self._cpu))
        Path(self._folder, f"traced-{uuid.uuid4().hex}.pickle").write_bytes(content)


def pytest_configure(config: pytest.Config) -> None:
    """Register the tracer in the processes that run tests."""
    if hasattr(config, "workerinput") or not config.getoption("numprocesses", None):
        config.pluginmanager.register(Tracer(os.environ[OUT]))


class Recording(NamedTuple):
    """The lines and arcs that the tests of a run execute."""

    tests: list[str]
    cpu: dict[str, float]
    """Processor time of each test [s]."""
    lines: Lines
    arcs: dict[str, set[Arc]]
    sources: dict[str, str]
    """The sources of the engine at that time."""

    def executing(self, file: str, lines: Iterable[int]) -> set[str]:
        """Return the tests that execute one of these lines."""
        wanted = int.from_bytes(nums_to_numbits(lines), "little") if (lines := set(lines)) else 0
        groups = self.lines.get(file, {}).items()
        found = {test for bits, tests in groups if int.from_bytes(bits, "little") & wanted for test in tests}
        return {self.tests[number] for number in found}

    def executed(self, file: str) -> set[int]:
        """Return the lines of a file that were executed."""
        return _lines(self.arcs.get(file, ()))


def prepare(folder: Path, engine: Path) -> dict[str, str]:
    """Prepare a folder for a recording; return the environment variables for pytest."""
    folder.mkdir(parents=True)
    (folder / "rc").write_text(SETTINGS.format(source=engine, folder=folder))
    return {OUT: str(folder), "COVERAGE_PROCESS_START": str(folder / "rc")}


def read(folder: Path, engine: Path | None = None) -> Recording:
    """Read a recording; the first call joins the files of all processes with the sources of the engine."""
    kept = folder / "recording.pickle"
    if not kept.exists():
        kept.write_bytes(pickle.dumps(tuple(_joined(folder, engine))))
    return Recording(*pickle.loads(kept.read_bytes()))


def _joined(folder: Path, engine: Path | None) -> Recording:
    numbers: dict[str, int] = {}
    cpu: dict[str, float] = {}
    lines: Lines = defaultdict(lambda: defaultdict(set))
    arcs: dict[str, set[Arc]] = defaultdict(set)
    for traced in sorted(folder.glob("traced-*.pickle")):
        found, tests, times = pickle.loads(traced.read_bytes())
        cpu |= {_id(test): time for test, time in times.items()}
        for file, packed in found.items():
            arcs[_relative(file)].update(map(unpacked, packed))
        for test in tests.keys() & times.keys():
            number = numbers.setdefault(_id(test), len(numbers))
            for file, bits in tests[test].items():
                lines[_relative(file)][bits if isinstance(bits, bytes) else nums_to_numbits(bits)].add(number)
    for child in sorted(folder.glob("child.*")):
        for test, file, pairs in _child(child):
            arcs[_relative(file)].update(pairs)
            if _id(test) in cpu:
                number = numbers.setdefault(_id(test), len(numbers))
                lines[_relative(file)][nums_to_numbits(_lines(pairs))].add(number)
    root = engine or Path(next(file for file in found if f"/{ENGINE}/" in file).partition(f"/{ENGINE}/")[0], ENGINE)
    sources = {f"{ENGINE}/{file.relative_to(root)}": file.read_text() for file in sorted(root.rglob("*.py"))}
    return Recording(list(numbers), cpu, {f: dict(by) for f, by in lines.items()}, dict(arcs), sources)


def _child(data: Path) -> Iterator[tuple[str, str, list[Arc]]]:
    """Yield the test, the file and its arcs from a file of coverage.py; nothing if a kill has damaged the file."""
    found: dict[tuple[str, str], list[Arc]] = defaultdict(list)
    try:
        with closing(sqlite3.connect(f"file:{data}?mode=ro", uri=True)) as database:
            for test, file, start, end in database.execute(ARCS):
                found[test, file].append((start, end))
    except sqlite3.DatabaseError:
        return
    yield from ((test, file, pairs) for (test, file), pairs in found.items())


def unpacked(arc: int) -> Arc:
    """Return the two lines of an arc as coverage.py's tracer packs it; a negative line is an entry or an exit.

    A packed arc has 28 bits for each line, then a sign bit for each (`CTracer_record_pair` in coverage.py's tracer.c).
    """
    start, end = arc & 0xFFFFFFF, arc >> 28 & 0xFFFFFFF
    return -start if arc & 1 << 56 else start, -end if arc & 1 << 57 else end


def _lines(arcs: Iterable[Arc]) -> set[int]:
    return {line for arc in arcs for line in arc if line > 0}


def _id(test: str) -> str:
    """Return the id of a test without the group that xdist appends."""
    return test if test.endswith("]") else re.sub(r"@[^@]*$", "", test)


def _relative(file: str) -> str:
    return ENGINE + file.rpartition(f"/{ENGINE}")[2]


def moved(before: str, after: str) -> dict[int, int]:
    """Return the new numbers of the lines that are in both versions of a file."""
    matcher = difflib.SequenceMatcher(None, before.splitlines(), after.splitlines(), autojunk=False)
    return {a + i + 1: b + i + 1 for a, b, size in matcher.get_matching_blocks() for i in range(size)}


class Lost(NamedTuple):
    """The lines and branches of a file that one run executed and another did not, as numbered in the later one."""

    lines: list[int]
    branches: list[Arc]


def compare(before: Recording, after: Recording) -> dict[str, Lost]:
    """Return the lines and branches that are still in the engine and were executed before, but not after."""
    found = {}
    for file, source in before.sources.items():
        if file not in after.sources:
            continue
        to = moved(source, after.sources[file])
        executed = after.executed(file)
        lines = sorted({to[line] for line in before.executed(file) if line in to} - executed)
        ends = to | {-line: -new for line, new in to.items()}
        was = {(ends[a], ends[b]) for a, b in before.arcs.get(file, ()) if a > 0 and a in ends and b in ends}
        branches = sorted(
            arc for arc in was - after.arcs.get(file, set()) if arc[0] in executed and arc[1] not in lines
        )
        if lines or branches:
            found[file] = Lost(lines, branches)
    return found


class Located(NamedTuple):
    """A recording, translated to the present engine, which may have changed since."""

    recording: Recording
    now: dict[str, str]

    def executing(self, file: str, lines: Iterable[int]) -> set[str]:
        """Return the tests that execute one of these lines of the present file."""
        before = self.recording.sources.get(file)
        if before is None:
            return set()
        if before != self.now[file]:
            back = {new: old for old, new in moved(before, self.now[file]).items()}
            lines = [back[line] for line in lines if line in back]
        return self.recording.executing(file, lines)
