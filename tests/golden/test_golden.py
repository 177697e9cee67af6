"""The engine's output equals the recorded goldens, byte for byte."""

from collections.abc import Iterator
from pathlib import Path
from types import ModuleType

import pytest

from tests.golden.golden import RECORDED, differences, explanations, names, record, subject

DO = "Change the code, or record it anew in a commit of its own."


def subjects() -> list[object]:
    return [pytest.param(name, marks=list(marks(subject(name)))) for name in names()]


def marks(one: ModuleType) -> Iterator[pytest.MarkDecorator]:
    if one.SUITE == "rest":
        yield pytest.mark.rest
    if hasattr(one, "GROUP"):
        yield pytest.mark.xdist_group(one.GROUP)


@pytest.mark.parametrize("name", subjects())
def test_is_as_recorded(name: str, tmp_path: Path) -> None:
    record(name, tmp_path)
    assert (RECORDED / name).is_dir(), f"nothing is recorded of {name}: python scripts/golden.py {name}"
    found = differences(RECORDED / name, tmp_path)
    found = [*explanations(name, RECORDED / name, tmp_path), *found] if found else []
    assert not found, "\n".join((f"{name} is not what it was at d475a3ac.", *found, DO))
