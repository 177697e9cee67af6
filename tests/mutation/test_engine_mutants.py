"""Mutants of the engine: which changes are made, which tests they run, and what counts as killed."""

import json
import os
import pickle
import sys
from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path
from textwrap import dedent
from typing import Any

import mutants
import pytest
import yaml
from coverage import Coverage, CoverageData
from mutants import Engine, batches, outcome, table
from mutation.changes import Source
from mutation.executed import Located, compare, read, unpacked
from mutation.trial import Ended

from tests.guarded import run_guarded

CHANGES = {
    "x = a < b": ["a < b -> a <= b", "a < b -> a >= b"],
    "x = a is not b": ["a is not b -> a is b"],
    "x = a not in b": ["a not in b -> a in b"],
    "x = a == (b)": ["a == (b) -> a != (b)"],
    "x = a and b": ["a and b -> (a)", "a and b -> (b)", "a and b -> a or b"],
    "x = a and b and c": ["a and b and c -> a and b or c", "a and b and c -> a or b and c"],
    "x = not a": ["not a -> (a)"],
    "x = -a": ["-a -> (a)"],
    "x = a + b * c": ["a + b * c -> a - b * c", "b * c -> b / c"],
    "x = 'a text' + b": ["x = 'a text' + b -> x = None"],
    "x = 3": ["3 -> 0", "3 -> 4", "3 -> 6"],
    "x = 0.0": ["0.0 -> (-1.0)", "0.0 -> 1.0"],
    "x = True": ["True -> False"],
    "x = None": ["None -> 1"],
    "x = 'key'": ["'key' -> ''", "'key' -> 'keyX'"],
    "x = 'a text for people'": [],
    "x = f'{a + 1}'": ["x = f'{a + 1}' -> x = None"],
    "x: Literal['no'] = a": ["x: Literal['no'] = a -> x: Literal['no'] = None"],
    "x = a if b else c": ["a if b else c -> a if (not (b)) else c"],
    "x = [a for a in b if c]": ["c -> (not (c))", "c -> True"],
    "x = f(a, b)": ["f(a, b) -> f(b, a)"],
    "x = f(a, b=c)": ["f(a, b=c) -> f(a)"],
    "x = min(a)": ["min(a) -> max(a)"],
    "x = a.startswith(b)": ["a.startswith(b) -> a.endswith(b)"],
    "x = cast('Type', a)": ["x = cast('Type', a) -> x = None"],
    "f(a)": ["f(a) -> pass"],
    "assert_never(a)": [],
    "x += a": ["x += a -> pass", "x += a -> x -= a"],
    "x.a = b": ["x.a = b -> pass"],
    "raise a": ["raise a -> pass"],
    "return a": ["return a -> return None"],
    "while a:\n    break": ["break -> continue", "break -> pass"],
    "if a:\n    g()\nelse:\n    h()": ["a -> (not (a))", "g() -> pass", "h() -> pass"],
    "try:\n    x.a = 'a b'\nexcept E:\n    g()": ["g() -> pass", "g() -> raise", "x.a = 'a b' -> pass"],
    "match a:\n    case 1:\n        g()\n    case _:\n        assert_never(a)": ["g() -> pass"],
    "def g(a=1): ...": ["1 -> 0", "1 -> 2"],
    "@bind\ndef g(): ...": ["@bind -> "],
    "@cache\ndef g(): ...": [],
    "if TYPE_CHECKING:\n    x = 1": [],
    "import a": [],
    "'a docstring'": [],
}


def test_the_changes_of_a_statement(tmp_path: Path) -> None:
    assert {code: shown(tmp_path / "source.py", code) for code in CHANGES} == CHANGES


def shown(file: Path, code: str) -> list[str]:
    """Return the changes of the statements in a function, each of which compiles."""
    file.write_text("def f():\n" + "\n".join(f"    {line}" for line in code.splitlines()))
    source = Source(file)
    changes = [change for statement in source.statements[1:] for change in source.changes(statement.node)]
    assert all(source.changed(change) for change in changes)
    return sorted({" -> ".join(source.shown(change)) for change in changes})


def engine(root: Path, **files: str) -> Engine:
    """Write a small engine into a folder, and return it."""
    for name, content in files.items():
        file = root / mutants.ENGINE / f"{name}.py"
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(dedent(content))
    return Engine(root)


def test_a_seed_draws_the_same_mutants_and_more_of_them_begin_with_these(tmp_path: Path) -> None:
    small = engine(tmp_path, one="\n".join(f"x{i} = f({i}, y) and {i}" for i in range(50)))
    names = [mutant.name for mutant in small.draw(40, 7)]
    assert len(set(names)) == 40
    assert names == [mutant.name for mutant in Engine(tmp_path).draw(40, 7)]
    assert names[:15] == [mutant.name for mutant in small.draw(15, 7)]
    assert names != [mutant.name for mutant in small.draw(40, 8)]


def test_what_can_not_be_changed_ends_the_drawing(tmp_path: Path) -> None:
    assert len(engine(tmp_path, one="x = True").draw(10, 1)) == 1


def recording(folder: Path, tests: dict[str, dict[str, Sequence[int]]]) -> Path:
    """Write what the plug-in writes after tests that execute these lines, one after the other, of these files."""
    files = {
        test: {str(folder / mutants.ENGINE / name): lines for name, lines in f.items()} for test, f in tests.items()
    }
    arcs: dict[str, set[int]] = {}
    for by_name in files.values():
        for name, lines in by_name.items():
            arcs.setdefault(name, set()).update(a | b << 28 for a, b in pairwise(lines))
    found = {test: {name: set(lines) for name, lines in by_name.items()} for test, by_name in files.items()}
    (folder / "traced-1.pickle").write_bytes(pickle.dumps((arcs, found, dict.fromkeys(tests, 0.5))))
    return folder


def test_a_mutant_runs_the_tests_that_execute_its_line_in_whatever_process(tmp_path: Path) -> None:
    small = engine(tmp_path, one="def f(x):\n    if x:\n        return 1\n    return g(x)\n")
    recording(tmp_path, {"t.py::one@t.py": {"one.py": [2, 3]}, "t.py::two[a@b]": {"one.py": [2]}})
    child = CoverageData(str(tmp_path / "child.1"))
    child.set_context("t.py::two[a@b]")
    child.add_arcs({str(tmp_path / mutants.ENGINE / "one.py"): [(2, 4)]})
    child.write()
    located = Located(
        read(tmp_path, tmp_path / mutants.ENGINE), {f: s.content.decode() for f, s in small.sources.items()}
    )
    tests = {mutant.line: small.tests(mutant, located) for mutant in small.draw(30, 1)}
    assert tests == {2: {"t.py::one", "t.py::two[a@b]"}, 3: {"t.py::one"}, 4: {"t.py::two[a@b]"}}


def test_what_is_executed_at_import_runs_the_tests_of_what_names_it(tmp_path: Path) -> None:
    small = engine(tmp_path, one="LIMIT = 5\n", two="def f(x):\n    return x < LIMIT\ndef g(x):\n    return x\n")
    recording(tmp_path, {"t.py::f": {"two.py": [2]}, "t.py::g": {"two.py": [4], "one.py": [1]}})
    located = Located(
        read(tmp_path, tmp_path / mutants.ENGINE), {f: s.content.decode() for f, s in small.sources.items()}
    )
    mutant = next(mutant for mutant in small.draw(30, 1) if mutant.file.endswith("one.py"))
    assert small.tests(mutant, located) == {"t.py::f"}


def test_what_is_not_executed_any_more_is_found_though_lines_moved(tmp_path: Path) -> None:
    (tmp_path / "before").mkdir()
    (tmp_path / "after").mkdir()
    engine(tmp_path / "before", one="a\nb\nc\nd\n")
    engine(tmp_path / "after", one="new\na\nb\nc\nd\n")
    before = read(recording(tmp_path / "before", {"t": {"one.py": [1, 2, 4]}, "u": {"one.py": [1, 3]}}))
    after = read(recording(tmp_path / "after", {"t": {"one.py": [2, 3]}, "u": {"one.py": [3, 5]}}))
    lost = compare(before, after)[f"{mutants.ENGINE}/one.py"]
    assert lost.lines == [4]
    assert lost.branches == []
    again = read(recording(tmp_path / "after", {}))
    assert compare(again, again) == {}


def test_arcs_are_read_as_the_tracer_packs_them(tmp_path: Path) -> None:
    file = tmp_path / "traced.py"
    file.write_text("def f(x):\n    if x:\n        return 1\n    return 2\n\n\nf(1)\n")
    traced = Coverage(data_file=None, branch=True, config_file=False, include=[str(file)])
    with traced.collect():
        exec(compile(file.read_text(), file, "exec"), {})
        collector: Any = traced._collector
        packed = set(collector.data[str(file)])
    arcs = {unpacked(arc) for arc in packed}
    assert arcs == set(traced.get_data().arcs(str(file)) or ())
    assert {(-1, 2), (2, 3), (3, -1), (7, -1)} <= arcs


def test_tests_run_cheapest_first_and_no_more_than_the_budget() -> None:
    cpu = {"a.py::dear": 30.0, "b.py::cheap": 0.01, "a.py::cheap": 0.02, "b.py::fair": 0.3, "c.py::endless": 90.0}
    assert batches(cpu, cpu) == [["a.py::cheap", "b.py::cheap", "b.py::fair"], ["a.py::dear", "c.py::endless"]]
    assert sum(map(len, batches({f"a.py::{i}" for i in range(1_000)}, {}))) < 130


def ended(how: str, own: float) -> Ended:
    return Ended(how, "t.py::t", own, 60.0, [])


def test_what_becomes_of_a_mutant() -> None:
    cpu = {"t.py::t": 2.0}
    assert outcome(ended("failed", 0.1), cpu) == "killed"
    assert outcome(ended("passed", 0.1), cpu) == "survived"
    assert outcome(ended("time", 0.1), cpu) == "hangs"
    assert outcome(ended("processor time", 21.0), cpu) == "hangs"
    assert outcome(ended("processor time", 19.0), cpu) == "survived"  # all its tests together took too long


def test_the_table_counts_the_suites_apart() -> None:
    rows = [("killed", "test"), ("killed", "rest"), ("hangs", "test"), ("survived", "rest"), ("not executed", "")]
    results = [{"folder": "app", "outcome": what, "suite": suite} for what, suite in rows]
    results.append({"folder": "app", "outcome": "survived", "suite": "rest", "equivalent": True})
    together = table(results).splitlines()[-1]
    assert together.split() == ["together", "6", "2", "3", "1", "1", "1", "1", "40.0", "60.0"]


def test_equivalent_mutants_are_few_in_the_engine_and_proved() -> None:
    entries = yaml.safe_load(mutants.EQUIVALENT.read_text()) or []
    assert len(entries) <= 0.05 * 400
    for entry in entries:
        assert sorted(entry) == ["change", "file", "in", "proof"]
        assert entry["in"] in (mutants.ROOT / entry["file"]).read_text(), entry


TESTS = """
    import subprocess, sys

    def test_fails():
        assert False

    def test_is_not_reached():
        raise SystemExit

    def test_starts_a_process_that_never_ends():
        subprocess.Popen([sys.executable, "-c", "while True: pass"], start_new_session=True)
        subprocess.run([sys.executable, "-c", "import time; time.sleep(1000)"])
"""


@pytest.mark.slow
def test_a_recording_has_the_lines_of_each_test(tmp_path: Path) -> None:
    test = "tests/app/test_ratelimit.py::test_a_bucket_is_never_fuller_than_full"
    options = ["--record", tmp_path / "recording", "--workers", "0"]
    command = [sys.executable, mutants.ROOT / "scripts/mutants.py", *options, "--", test]
    done = run_guarded(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    located = Located(read(tmp_path / "recording"), {})
    file = "engine/lumen/upkeep/ratelimit.py"
    assert located.recording.tests == [test]
    assert len(located.recording.executed(file)) > 10
    assert located.recording.executing(file, range(1, 200)) == {test}


@pytest.mark.slow
@pytest.mark.parametrize(
    ("tests", "how", "failed"),
    [
        (["test_fails", "test_is_not_reached"], "failed", ["test_it.py::test_fails"]),
        (["test_starts_a_process_that_never_ends"], "processor time", []),
    ],
)
def test_a_trial_ends_with_all_its_processes(tmp_path: Path, tests: list[str], how: str, failed: list[str]) -> None:
    (tmp_path / "test_it.py").write_text(dedent(TESTS))
    job = tmp_path / "job.json"
    job.write_text(
        json.dumps({"batches": [[f"test_it.py::{t}" for t in tests]], "cpu": 2, "idle": 600, "every": False})
    )
    environment = {**os.environ, "PYTHONPATH": str(mutants.ROOT / "scripts"), "PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1"}
    command = [sys.executable, "-m", "mutation.trial", job]
    done = run_guarded(command, cwd=tmp_path, env=environment, capture_output=True, text=True, check=True)
    found = Ended(*json.loads(done.stdout))
    assert (found.how, found.failed) == (how, failed)
    assert found.test == f"test_it.py::{tests[0]}"
    assert not [name for name in os.listdir("/proc") if name.isdecimal() and works_in(int(name), tmp_path)]


def works_in(pid: int, folder: Path) -> bool:
    """Return whether a process has this working folder."""
    try:
        return Path(f"/proc/{pid}/cwd").readlink() == folder
    except OSError:
        return False
