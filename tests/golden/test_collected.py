"""A test that is silently not collected is named, and so is a folder that has fewer than it had."""

from pathlib import Path

import pytest

from tests.golden import collected
from tests.golden.collected import counts, faults

FLOORS = {"tests/bus": {"functions": 2, "tests": 3, "cases": 2}}
NAMES = [
    "tests/bus/test_a.py::test_one",
    "tests/bus/test_a.py::TestB::test_two[1]",
    "tests/bus/test_a.py::TestB::test_two[2]",
]
FILES = {
    "tests/bus/test_a.py": "def test_one(): pass\nclass TestB:\n    def test_two(self): pass\ndef helper(): pass\n",
    "tests/bus/cases.yaml": "# rows\na row: {x: 1}\nanother:\n  in: it\n",
}


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder of tests, with 2 functions, 3 tests and 2 rows of a table."""
    monkeypatch.setattr(collected, "ROOT", tmp_path)
    monkeypatch.setattr(collected, "TESTS", tmp_path / "tests")
    for name, text in FILES.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text, "utf-8")
    return tmp_path


def test_what_is_collected_is_counted_by_folder() -> None:
    assert counts(NAMES) == FLOORS
    assert list(faults(NAMES, FLOORS)) == []


def test_more_is_no_fault() -> None:
    assert list(faults([*NAMES, "tests/cli/test_b.py::test_new"], FLOORS)) == []


def test_a_function_that_is_not_collected_is_named() -> None:
    found = list(faults(NAMES[1:], {}))
    assert found == ["tests/bus/test_a.py::test_one is written and not collected"]


def test_a_file_with_a_name_that_pytest_does_not_know_is_named(folder: Path) -> None:
    (folder / "tests/bus/tests_b.py").write_text("def test_lost(): pass\n", "utf-8")
    assert list(faults(NAMES, FLOORS)) == ["tests/bus/tests_b.py::test_lost is written and not collected"]


def test_a_name_that_is_used_twice_is_named(folder: Path) -> None:
    file = folder / "tests/bus/test_a.py"
    file.write_text(file.read_text("utf-8") + "def test_one(): pass\n", "utf-8")
    assert list(faults(NAMES, FLOORS)) == ["tests/bus/test_a.py::test_one is written 2 times, and collected once"]


@pytest.mark.parametrize("gone", ["tests/bus/test_a.py", "tests/bus/cases.yaml"])
def test_a_file_that_is_gone_is_noticed(gone: str, folder: Path) -> None:
    (folder / gone).unlink()
    left = [name for name in NAMES if not name.startswith(gone)]
    assert list(faults(left, FLOORS))
    assert all(line.startswith("tests/bus has 0 ") for line in faults(left, FLOORS))


def test_fewer_parameters_are_noticed() -> None:
    (found,) = faults(NAMES[:2], FLOORS)
    assert found.startswith("tests/bus has 2 tests, and had 3")
