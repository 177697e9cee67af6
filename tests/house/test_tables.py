"""A table of cases is one test: it runs every row and lists all failures."""

import inspect
import os
from pathlib import Path
from traceback import extract_tb

import pytest

from tests.tables import CasesFailedError, check, for_each

RUN: list[tuple[int, int, int]] = []


@for_each("a", [1, 2])
@for_each("b, c", [(1, 2), pytest.param(2, 3, id="late")])
def smaller(a: int, b: int, c: int, three: int) -> None:
    RUN.append((a, b, c))
    assert a < b, "a is smaller"
    if c == three:
        raise ValueError("c is three")


def test_every_row_runs_and_all_failures_are_listed() -> None:
    RUN.clear()
    with pytest.raises(CasesFailedError) as caught:
        smaller(three=3)
    assert RUN == [(1, 1, 2), (1, 2, 3), (2, 1, 2), (2, 2, 3)]
    words = str(caught.value).split("\n")
    assert words[0] == "4 of 4 cases fail:"
    assert [line for line in words if line.startswith("-")] == [
        "- 1-2-1: a is smaller",
        "- late-1: ValueError: c is three",
        "- 1-2-2: a is smaller",
        "- late-2: a is smaller",
    ]
    assert caught.value.__cause__
    line = extract_tb(caught.value.__cause__.__traceback__)[-1].lineno
    assert f"  (tests/house/test_tables.py:{line})" in words


def test_pytest_passes_only_the_fixtures() -> None:
    assert list(inspect.signature(smaller).parameters) == ["three"]


def test_a_table_without_a_case_is_refused() -> None:
    with pytest.raises(ValueError, match="without a case"):
        for_each("a", [])
    with pytest.raises(AssertionError, match="without a case"):
        check([])


def test_many_failures_are_named_and_only_some_described() -> None:
    with pytest.raises(CasesFailedError) as caught:
        check((f"case {number}", lambda: pytest.fail("no")) for number in range(30))
    lines = str(caught.value).split("\n")
    assert lines[0] == "30 of 30 cases fail:"
    assert lines[-1] == "- case 29"


@for_each("number", [0, 1])
def test_every_row_has_its_own_folder_patches_and_output(
    number: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    assert [*tmp_path.iterdir()] == []
    (tmp_path / "file").touch()
    assert "LUMEN_ROW" not in os.environ
    monkeypatch.setenv("LUMEN_ROW", "set")
    print(number)  # noqa: T201
    assert capsys.readouterr().out == f"{number}\n"
    print("left behind")  # noqa: T201
