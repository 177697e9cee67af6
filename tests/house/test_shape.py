"""The figures of a small package of which everything can be counted by hand."""

import json
from pathlib import Path

import pytest
from scripts import shape
from scripts.shape import Floor, Size, When

from tests.guarded import run_guarded
from tests.provided import program
from tests.waiting import HANG

ORDER = """
[tool.importlinter]
root_package = "lumen"

[[tool.importlinter.contracts]]
type = "layers"
layers = ["lumen.attic", "lumen.kitchen | lumen.parlour", "(lumen.cellar)", "lumen.errors"]
"""

HOUSE = {
    "__init__.py": "",
    "errors.py": "class HouseError(Exception):\n    '''Base of all.'''\n",
    "attic/__init__.py": "from lumen.kitchen import oven\n",
    "attic/words.py": "MOST = 1\n\nimport lumen.cellar.wine\n",
    "kitchen/__init__.py": "",
    "kitchen/words.py": "MOST, LEAST = 2, 1\n",
    "kitchen/oven.py": """
from typing import TYPE_CHECKING, TypeVar

if TYPE_CHECKING:
    from lumen.kitchen import pan

    Heat = dict[str, int]

Item = TypeVar("Item")
_MOST = 3


class Oven:
    MOST = 4

    class Door: ...

    def bake(self):
        from lumen.attic import words

        return words.MOST
""",
    "kitchen/pan.py": "from lumen.kitchen.oven import Oven\n\n\nclass Pan(Oven): ...\n\n\nclass _Lid: ...\n",
    "parlour/words.py": "MOST: int = 3\n",
    "parlour/table.py": "from lumen.kitchen.pan import Pan\n\nHeat = Pan | None\nLAMP = 'lamp'\n",
    "cellar/words.py": "MOST = 4\n",
    "cellar/wine.py": """
def pour(glass):
    match glass:
        case PourWine():
            def half(): ...


class _Lid: ...
class Item: ...
""",
}


@pytest.fixture
def root(tmp_path: Path) -> Path:
    for name, text in {**HOUSE, "../../pyproject.toml": ORDER}.items():
        (tmp_path / "engine/lumen" / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / "engine/lumen" / name).write_text(text, encoding="utf-8")
    return tmp_path


@pytest.fixture
def files(root: Path) -> list[shape.SourceFile]:
    return shape.read(root / "engine/lumen")


@pytest.fixture
def order() -> list[set[str]]:
    return shape.floor_order(ORDER)


def test_floors_stand_in_the_order_of_the_contract(files, order):
    assert order == [{"attic"}, {"kitchen", "parlour"}, {"cellar"}, {"errors"}]
    assert shape.floors(files, order) == [
        Floor("attic", 2, 4),
        Floor("kitchen", 4, 29),
        Floor("parlour", 2, 5),
        Floor("cellar", 2, 10),
        Floor("top-level files", 2, 2),
    ]


def test_sizes_are_lines_of_files_and_of_functions(files):
    assert shape.file_sizes(files)[-1] == Size(21, "kitchen/oven.py")
    assert [size.lines for size in shape.file_sizes(files)] == [1, 1, 1, 1, 2, 3, 4, 7, 9, 21]
    assert shape.function_sizes(files) == [
        Size(1, "half in cellar/wine.py"),
        Size(4, "bake in kitchen/oven.py"),
        Size(4, "pour in cellar/wine.py"),
    ]


def test_types_of_the_same_name_are_told_with_their_files(files):
    assert shape.shared(shape.type_names, files, 1) == {
        "Heat": ["kitchen/oven.py", "parlour/table.py"],
        "_Lid": ["cellar/wine.py", "kitchen/pan.py"],
    }


def test_constants_and_names_of_files_are_told_that_many_share(files):
    words = [f"{floor}/words.py" for floor in ("attic", "cellar", "kitchen", "parlour")]
    assert shape.shared(shape.constants, files, 1) == {"MOST": words}
    assert shape.shared(shape.constants, files, 4) == {}
    assert shape.shared(shape.file_name, files, 3) == {"words.py": words}


def test_circles_close_over_the_imports_that_are_counted(files):
    arrows = shape.imports(files)
    assert shape.circles(arrows, [When.LOADING]) == []
    assert shape.circles(arrows, [When.LOADING, When.TYPES]) == [["kitchen/oven.py", "kitchen/pan.py"]]
    assert ("kitchen/oven.py", "attic/words.py", When.LATE) in arrows
    assert ("attic/words.py", "cellar/wine.py", When.LOADING) in arrows
    assert ("attic/__init__.py", "kitchen/oven.py", When.LOADING) in arrows


def test_arrows_up_lead_to_a_floor_above_or_beside(files, order):
    assert shape.arrows_up(shape.imports(files), order) == [
        "kitchen/oven.py -> attic/words.py (in a function)",
        "parlour/table.py -> kitchen/pan.py (at loading)",
    ]


def test_an_action_is_known_where_a_name_or_a_text_of_names_holds_its_word(files):
    assert shape.action_files(files, "pour") == ["cellar/wine.py"]
    assert shape.action_files(files, "lamp") == ["parlour/table.py"]
    assert shape.action_files(files, "base") == [], "what a docstring says is no name"


def test_figures_stand_in_the_table_and_the_report(files, order):
    measured = shape.measure(files, order, "pour")
    assert "| public types of the same name | 1 |\n" in shape.table(measured)
    assert "| together | 12 files, 50 lines |\n" in shape.table(measured)
    assert "  Heat (2): kitchen/oven.py, parlour/table.py\n" in shape.report(measured)


@pytest.mark.parametrize(("number", "figure"), [(87, 87), (381, 380), (7470, 7500), (51739, 52000), (0, 0)])
def test_lines_are_rounded_in_the_table(number, figure):
    assert shape.rounded(number) == figure


def test_a_page_is_written_and_checks_until_it_is_stale(root):
    page = root / "page.md"
    page.write_text(f"# House\n\n{shape.BEGIN}{shape.END}\n\nMore.\n", encoding="utf-8")
    with pytest.raises(SystemExit, match="--write"):
        shape.main(["--root", str(root), "--check", str(page)])
    shape.main(["--root", str(root), "--write", str(page)])
    shape.main(["--root", str(root), "--check", str(page)])
    text = page.read_text(encoding="utf-8")
    assert text.startswith(f"# House\n\n{shape.BEGIN}| what |")
    assert text.endswith(f"|\n{shape.END}\n\nMore.\n")
    (root / "engine/lumen/cellar/cork.py").write_text("", encoding="utf-8")
    with pytest.raises(SystemExit, match="--write"):
        shape.main(["--root", str(root), "--check", str(page)])


def test_a_page_without_markers_is_refused():
    with pytest.raises(ValueError, match="shape: written by"):
        shape.placed("# House\n", "")


def test_all_of_it_is_data_too(root, capsys):
    shape.main(["--root", str(root), "--action", "pour", "--json"])
    figures = json.loads(capsys.readouterr().out)
    assert figures["floors"][0] == {"name": "attic", "files": 2, "lines": 4}
    assert figures["action_files"] == ["cellar/wine.py"]


def test_a_commit_tells_the_files_that_it_touched(root, capsys):
    git = [program("git"), "-c", "user.name=a", "-c", "user.email=a@b.c", "-C", str(root)]
    for command in (["init", "-q"], ["add", "."], ["commit", "-q", "-m", "Builds"]):
        run_guarded([*git, *command], check=True, timeout=HANG)
    shape.main(["--root", str(root), "--commit", "HEAD"])
    assert capsys.readouterr().out.startswith("Python files of the package in HEAD: 12\n  __init__.py\n")
