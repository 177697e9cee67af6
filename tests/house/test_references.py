"""References to a moved module or file are found in code by syntax, and elsewhere by spelling."""

from collections.abc import Callable

import pytest
from scripts.references import Edit, Moved, code_edits, module_of, page_edits, rewritten, spelled_edits

MOVED = Moved(
    {
        "attic/oven.py": "kitchen/oven.py",
        "attic/pan/__init__.py": "kitchen/pans/__init__.py",
        "attic/pan/handle.py": "kitchen/pans/handles.py",
        "attic/pan/lid.py": "kitchen/pans/lids.py",
        "table.py": "parlour/table_top.py",
        "attic/table/__init__.py": "table/__init__.py",
    },
    {"attic/pan": "kitchen/pans", "attic/table": "table"},
    ["__init__.py", "attic/__init__.py", "attic/attic_words.py", "state.py"],
    ["lumen.attic.pan.handle"],
)
"""`lumen.table` moves, and another module gets its name. `lumen.attic.pan` offers a name like a file in it."""


def followed(text: str, edits: Callable[[str, Moved], list[Edit]], moved: Moved = MOVED) -> str:
    return rewritten(text, edits(text, moved))


@pytest.mark.parametrize(
    ("before", "after"),
    [
        ("from lumen.attic.oven import bake", "from lumen.kitchen.oven import bake"),
        ("from lumen.attic.pan import Pan, lid", "from lumen.kitchen.pans import Pan, lids as lid"),
        ("from lumen.attic.pan import handle", "from lumen.kitchen.pans import handle"),
        ("from lumen.attic.pan.handle import handle", "from lumen.kitchen.pans.handles import handle"),
        ("from lumen.attic.pan import lid as top", "from lumen.kitchen.pans import lids as top"),
        ("from lumen.attic import oven", "from lumen.kitchen import oven"),
        (
            "def f():\n    from lumen.attic import attic_words, oven",
            "def f():\n    from lumen.attic import attic_words\n    from lumen.kitchen import oven",
        ),
        ("import lumen.attic.oven as hot", "import lumen.kitchen.oven as hot"),
        (
            "import lumen.attic.pan.lid\nlumen.attic.pan.lid.x",
            "import lumen.kitchen.pans.lids\nlumen.kitchen.pans.lids.x",
        ),
        ("from lumen.attic.pan import (\n# a\n    Pan)", "from lumen.kitchen.pans import (\n# a\n    Pan)"),
        ('def f(x: "lumen.attic.oven.Oven"): ...', 'def f(x: "lumen.kitchen.oven.Oven"): ...'),
        ("if T:\n    from lumen.attic.oven import A", "if T:\n    from lumen.kitchen.oven import A"),
        ("ä = 'ö'; import lumen.attic.oven", "ä = 'ö'; import lumen.kitchen.oven"),
    ],
)
def test_imports_follow_what_they_name(before: str, after: str) -> None:
    assert followed(before, code_edits) == after


@pytest.mark.parametrize(
    "text",
    [
        "from lumen.attic import attic_words",
        "from lumen.table import Table",
        "from lumen.attic.attic_words import oven",
        "from other.attic.oven import bake",
        "key = 'lumen.attic.oven'",
    ],
)
def test_code_stays_that_names_nothing_moved(text: str) -> None:
    assert followed(text, code_edits) == text


def test_a_file_that_gets_an_old_name_means_the_moved_module_by_it() -> None:
    text = "from lumen.table import Table\nHOME = 'lumen.table'"
    seen = MOVED.for_file("table/__init__.pyi")
    assert followed(text, code_edits, seen) == "from lumen.parlour.table_top import Table\nHOME = 'lumen.table'"
    assert followed("'lumen.table'", spelled_edits, seen) == "'lumen.parlour.table_top'"


def test_an_import_with_a_comment_is_split_by_hand() -> None:
    with pytest.raises(ValueError, match="by hand"):
        code_edits("from lumen.attic import (  # both\n    attic_words,\n    oven,\n)", MOVED)


@pytest.mark.parametrize(
    ("before", "after"),
    [
        ('"lumen.attic.oven:bake"', '"lumen.kitchen.oven:bake"'),
        ("`lumen.attic.pan.lid.Lid`.", "`lumen.kitchen.pans.lids.Lid`."),
        ("see attic/pan/lid.py:top", "see kitchen/pans/lids.py:top"),
        ("](../engine/lumen/attic/oven.py)", "](../engine/lumen/kitchen/oven.py)"),
        ("engine/lumen/table.py", "engine/lumen/parlour/table_top.py"),
        ("`attic/pan/` and `attic/pan`.", "`kitchen/pans/` and `kitchen/pans`."),
    ],
)
def test_spelled_names_follow(before: str, after: str) -> None:
    assert followed(before, spelled_edits) == after


@pytest.mark.parametrize(
    "text",
    ["lumen.state", "lumen.attic.NAO.command", "lumen.table", "my-lumen.attic.oven", "tests/attic/oven.py", "table.py"],
)
def test_spelled_names_stay_that_only_look_alike(text: str) -> None:
    assert followed(text, spelled_edits) == text


def test_spelled_names_within_an_edited_import_are_edited_once() -> None:
    text = "from lumen.attic.oven import bake  # lumen.attic.oven"
    code = code_edits(text, MOVED)
    done = rewritten(text, [*code, *spelled_edits(text, MOVED, code)])
    assert done == "from lumen.kitchen.oven import bake  # lumen.kitchen.oven"


def test_python_in_pages_follows_and_fragments_stay() -> None:
    page = "lumen.attic.oven\n```python\nimport lumen.attic.oven\n```\n```python\nif lumen.attic.oven\n```\n"
    assert followed(page, page_edits) == page.replace("import lumen.attic", "import lumen.kitchen")


def test_the_module_of_a_file() -> None:
    files = ["a/b.py", "a/__init__.py", "__init__.py", "a/__init__.pyi", "a/b.md"]
    assert [module_of(file) for file in files] == ["lumen.a.b", "lumen.a", "lumen", "lumen.a", None]
