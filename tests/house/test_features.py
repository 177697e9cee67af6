"""The figures of features, for a small package of which everything can be counted by hand."""

import ast

from scripts.features import elsewhere_by_feature, files_elsewhere, imports_by_core, imports_by_features, small_modules
from scripts.source_files import SourceFile


def module(path: str) -> str:
    return f"lumen/{path}".removesuffix(".py").removesuffix("/__init__").replace("/", ".")


HOUSE = {
    "kitchen.py": "from lumen.features.lamp import light\n\n\ndef cook():\n    import lumen.features.bell.ring\n",
    "features/core.py": "ROW = 'lumen.features.lamp.part:make'\n",
    "features/lamp/__init__.py": "from lumen.feature import Feature\n",
    "features/lamp/light.py": "from lumen.features.lamp import wick\n",
    "features/lamp/wick.py": "LENGTH = 3\n",
    "features/lamp/part.py": "from lumen.features.bell.ring import ring\nfrom lumen.kitchen import cook\n",
    "features/bell/__init__.py": "",
    "features/bell/ring.py": "from lumen.features.bell.sound import LOUD\n",
    "features/bell/sound.py": "LOUD = 1\n" * 60,
}
FILES = [SourceFile(path, module(path), text, ast.parse(text)) for path, text in HOUSE.items()]


def test_an_import_of_a_feature_by_the_core_is_counted_wherever_it_stands() -> None:
    assert [str(place) for place in imports_by_core(FILES)] == [
        "kitchen.py:1: imports lumen.features.lamp",
        "kitchen.py:5: imports lumen.features.bell.ring",
    ]


def test_a_feature_may_import_itself_and_the_core_but_no_other() -> None:
    assert [str(place) for place in imports_by_features(FILES)] == [
        "features/lamp/part.py:1: imports lumen.features.bell.ring"
    ]


def test_a_small_module_needs_a_second_reader_or_a_row_that_names_it() -> None:
    assert [str(place) for place in small_modules(FILES)] == [
        "features/lamp/wick.py:1: has 1 lines, and only features/lamp/light.py imports it"
    ]


def test_a_module_of_the_core_that_only_one_feature_imports_is_a_file_of_it_elsewhere() -> None:
    assert [str(place) for place in files_elsewhere(FILES)] == [
        "kitchen.py:1: belongs to features/lamp: nothing else imports it"
    ]
    assert elsewhere_by_feature(FILES) == {"lamp": ["kitchen.py"], "bell": []}
