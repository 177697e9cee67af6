"""A search that finds nothing fails, and so does a test without parameters to try."""

from pathlib import Path

import pytest
from scripts import shape

from tests.scanning import matching


def test_what_is_found_comes_once_and_in_order(tmp_path: Path) -> None:
    for name in ("b.py", "a.py", "a.md"):
        (tmp_path / name).touch()
    assert [file.name for file in matching(tmp_path, "*.py", "a.*")] == ["a.md", "a.py", "b.py"]


def test_a_pattern_that_matches_nothing_fails(tmp_path: Path) -> None:
    (tmp_path / "a.py").touch()
    with pytest.raises(AssertionError, match=r"no file matches \*\.yaml in"):
        matching(tmp_path, "*.py", "*.yaml")


def test_the_shape_of_no_package_is_an_error(tmp_path: Path) -> None:
    with pytest.raises(SystemExit, match="no Python file is beneath"):
        shape.read(tmp_path)


def test_no_parameters_are_an_error(pytestconfig: pytest.Config) -> None:
    assert pytestconfig.getini("empty_parameter_set_mark") == "fail_at_collect"
