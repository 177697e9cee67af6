"""A folder that says in its docstring what each of its files is for says it of all of them, and of no other."""

import ast
import re
from pathlib import Path

import pytest

ENGINE = Path(__file__).parents[2] / "engine/lumen"
LINE = re.compile(r"^    (\w+(?:\.py|/)) +\S", re.MULTILINE)


@pytest.mark.parametrize("folder", ["buses", "modules", "robots"])
def test_each_file_is_named_once(folder: str) -> None:
    said = ast.get_docstring(ast.parse((ENGINE / folder / "__init__.py").read_text()), clean=False)
    assert said
    there = [
        path.name + "/" * path.is_dir()
        for path in (ENGINE / folder).iterdir()
        if path.suffix == ".py" or (path / "__init__.py").exists()
    ]
    assert sorted(LINE.findall(said)) == sorted(name for name in there if name != "__init__.py")
