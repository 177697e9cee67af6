"""The rules of the code base that every change must keep; `python scripts/shape.py` prints violations."""

import re

import pytest
from closed_lists import ON_PURPOSE
from figures import Figure, beyond_ceilings, figures
from scripts.shape import PACKAGE, ROOT, Shape, floor_order, measure, read
from source_files import SourceFile

from lumen.upkeep.garbage import gc_paused
from tests.house.ceilings import ENTERING, ceilings
from tests.scanning import matching


@pytest.fixture(scope="module")
def files() -> list[SourceFile]:
    with gc_paused():  # a search through all trees finds nothing and takes longer than reading them
        return read(ROOT / PACKAGE)


@pytest.fixture(scope="module")
def house(files: list[SourceFile]) -> Shape:
    order = floor_order((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    return measure(files, order)


@pytest.fixture(scope="module")
def counted(files: list[SourceFile]) -> dict[str, Figure]:
    with gc_paused():
        return figures(files)


def test_a_public_class_or_alias_has_a_name_of_its_own(house: Shape) -> None:
    assert house.repeated_types == {}


def test_no_files_import_each_other_in_a_circle_for_types_and_late_neither(house: Shape) -> None:
    assert [circle for found in house.circles.values() for circle in found] == []


def test_no_file_imports_what_stands_above_or_beside_its_floor(house: Shape) -> None:
    assert house.arrows_up == []


def test_the_figures_of_the_architecture_are_at_their_ceilings(counted: dict[str, Figure]) -> None:
    held = {name: ceiling for name, ceiling in ceilings().items() if name != ENTERING}
    assert beyond_ceilings(counted, held) == []


def test_each_reason_for_a_closed_list_is_about_one_that_exists(counted: dict[str, Figure]) -> None:
    assert counted["lists closed on purpose"].value == len(ON_PURPOSE)


def test_every_thread_is_watched() -> None:
    """A thread that a fault ends is restarted or reported (`lumen.upkeep.threads`), except three.

    The thread of the records serves one desk. A fault in drawing a picture of a film is raised by the wait for that
    picture. The thread that reads the orders for a skill ends its process.
    """
    made = {
        str(file.relative_to(ROOT / PACKAGE))
        for file in matching(ROOT / PACKAGE, "**/*.py")
        if re.search(r"threading\.Thread\(|ThreadPoolExecutor\(", file.read_text("utf-8"))
    }
    assert made == {"upkeep/threads.py", "run/reload/records.py", "features/simulation/filming/film.py", "skills.py"}
