"""The output of a run: few lines when all is well, and a sentence above the traceback of a failure."""

import os
import sys
from pathlib import Path

import pytest

from tests import ROOT
from tests.guarded import PIPE, STDOUT, run_guarded
from tests.progress import duration, time_left

FAILING = '''
import pytest

def test_a_robot_that_hangs_is_reported():
    assert 1 == 2, "nothing was reported"

@pytest.mark.xdist_group("door")
@pytest.mark.parametrize("day", ["week_day"])
def test_hours(day):
    """The door opens at nine.

    On each day.
    """
    pytest.fail("it is shut", pytrace=False)

@pytest.fixture
def hall():
    raise ValueError("no hall")

def test_a_hall_is_lit(hall):
    pass
'''
SKIPPING = """
import pytest

@pytest.mark.parametrize("number", range(300))
def test_well(number):
    if number < 3:
        pytest.skip("chromium is not here")
"""


def run(folder: Path, text: str, *more: str) -> list[str]:
    """Return the lines of a run of such a file."""
    (folder / "test_it.py").write_text(text)
    (folder / "pytest.ini").write_text("[pytest]\n")
    words = [sys.executable, "-m", "pytest", "-q", "-p", "tests.progress", *more, "test_it.py"]
    environment = {name: value for name, value in os.environ.items() if not name.startswith("PYTEST_")}
    environment |= {"PYTHONPATH": str(ROOT), "COLUMNS": "120"}
    done = run_guarded(words, cwd=folder, env=environment, stdout=PIPE, stderr=STDOUT, text=True, timeout=300)
    return str(done.stdout).splitlines()


@pytest.mark.parametrize("workers", [(), ("-n", "2", "--dist", "loadgroup")], ids=["alone", "two_workers"])
def test_a_failure_begins_with_what_was_expected(tmp_path: Path, workers: tuple[str, ...]) -> None:
    lines = run(tmp_path, FAILING, *workers)
    again = f"Again: {sys.executable} -m pytest test_it.py::test_a_robot_that_hangs_is_reported"
    ended = lines.index(next(line for line in lines if "= FAILURES =" in line or "= ERRORS =" in line))
    at_once = {line.strip() for line in lines[:ended] if "failed:" in line}
    names = ("test_a_robot_that_hangs_is_reported", "test_hours[week_day]", "test_a_hall_is_lit")
    assert at_once == {f"failed: test_it.py::{name}" for name in names}
    expected = lines.index("Expected: a robot that hangs is reported.")
    assert lines[expected + 1 : expected + 4] == ["Found: nothing was reported", "assert 1 == 2", again]
    assert expected < lines.index('>       assert 1 == 2, "nothing was reported"')
    expected = lines.index("Expected: The door opens at nine (week day).")
    assert lines[expected + 1] == f"Again: {sys.executable} -m pytest 'test_it.py::test_hours[week_day]'"
    assert "it is shut" in lines[expected + 2 :]
    expected = lines.index("Expected: a hall is lit.")
    assert lines[expected + 1] == "Found: ValueError: no hall"
    assert {line for line in lines if line.startswith(("FAILED", "ERROR "))} == {
        "FAILED test_it.py::test_a_robot_that_hangs_is_reported - AssertionError: nothing was reported",
        "FAILED test_it.py::test_hours[week_day] - Failed: it is shut",
        "ERROR test_it.py::test_a_hall_is_lit - ValueError: no hall",
    }


def test_a_run_that_is_well_prints_few_lines_and_each_reason_for_skipping_once(tmp_path: Path) -> None:
    """The first line estimates the time: from `--expect-cpu`, or from the last run."""
    for more in (("--expect-cpu", "100"), ()):
        lines = run(tmp_path, SKIPPING, *more)
        assert lines[0].startswith("300 tests: takes about ")
        assert len(lines) < 20
        assert lines[lines.index("Skipped:") + 1] == "     3  chromium is not here"
        assert lines[-1].startswith("297 passed, 3 skipped in ")


def test_verbose_output_is_that_of_pytest(tmp_path: Path) -> None:
    lines = run(tmp_path, SKIPPING, "-vv", "-rs")
    assert any(line.startswith("test_it.py::test_well[299] PASSED") for line in lines)
    assert any(line.startswith("SKIPPED [3] test_it.py:") for line in lines)
    assert "Skipped:" not in lines


@pytest.mark.parametrize(
    ("seconds", "expected"), [(0.2, "1 s"), (80, "80 s"), (89.9, "90 s"), (90, "2 minutes"), (400, "7 minutes")]
)
def test_durations_are_rounded_to_what_a_person_can_use(seconds: float, expected: str) -> None:
    assert duration(seconds) == expected


def test_a_run_of_few_tests_does_not_say_how_long_many_take(tmp_path: Path) -> None:
    run(tmp_path, "def test_alone(): pass\n")
    assert not any("takes about" in line for line in run(tmp_path, SKIPPING))


@pytest.mark.parametrize(
    ("share", "passed", "expected", "left"),
    [(0.01, 5.0, None, None), (0.5, 100.0, None, 100.0), (0.0, 100.0, 200.0, 100.0), (0.5, 100.0, 120.0, 60.0)],
)
def test_the_time_left_is_first_as_expected_then_as_it_has_been(
    share: float, passed: float, expected: float | None, left: float | None
) -> None:
    assert time_left(share, passed, expected) == left
