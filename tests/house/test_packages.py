"""Folders are packages, visible to contracts; a package that lists the purpose of files lists all of them."""

import ast
import re

import pytest

from tests import ROOT
from tests.scanning import matching

ENGINE = ROOT / "engine/lumen"
LINE = re.compile(r"^    (\w+(?:\.py|/)) +\S", re.MULTILINE)


@pytest.mark.parametrize("folder", ["bus", "features/rabbitmq", "robot"])
def test_each_file_is_named_once(folder: str) -> None:
    said = ast.get_docstring(ast.parse((ENGINE / folder / "__init__.py").read_text()), clean=False)
    assert said
    there = [
        path.name + "/" * path.is_dir()
        for path in (ENGINE / folder).iterdir()
        if path.suffix == ".py" or (path / "__init__.py").exists()
    ]
    assert sorted(LINE.findall(said)) == sorted(name for name in there if name != "__init__.py")


def test_a_folder_of_python_files_is_a_package_since_a_contract_sees_no_other() -> None:
    folders = {file.parent for tree in (ENGINE, ROOT / "tests") for file in matching(tree, "**/*.py")}
    alone = [folder for folder in folders if not (folder / "__init__.py").is_file()]
    code = ROOT / "tests/features/skills/project/skills"  # a project's own, which no package imports
    noting = ROOT / "tests/golden/noting"  # Python imports sitecustomize.py from there by its own name
    assert sorted(alone) == [code, noting]


def test_nothing_of_the_command_line_is_named_outside_its_tests_but_the_command() -> None:
    for tree in ("tests", "benchmarks", "scripts", "docs", "examples"):
        for file in matching(ROOT / tree, "**/*.py"):
            if "tests/cli" not in str(file) and file.name not in (
                "command_pages.py",
                "test_documented.py",
                "adapters_language.py",
            ):
                named = re.findall(r"^ *(?:from|import) +(lumen\.cli\b[^\n]*)", file.read_text("utf-8"), re.MULTILINE)
                assert set(named) <= {"lumen.cli.main import main"}, file
