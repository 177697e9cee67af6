"""Packages whose names are imported at their first use: type checkers read the names in a stub."""

import ast
from pathlib import Path
from types import ModuleType

import pytest

import lumen.bus as bus
import lumen.fuzzy as fuzzy
import lumen.motion as motion
import lumen.project as project
import lumen.statechart as statechart

PACKAGES = [bus, fuzzy, motion, project, statechart]


@pytest.mark.parametrize("package", PACKAGES)
def test_a_stub_declares_the_names_that_the_package_offers_from_where_it_has_them(package: ModuleType) -> None:
    tree = ast.parse(Path(str(package.__file__)).with_suffix(".pyi").read_text("utf-8"))
    imports = [node for node in tree.body if isinstance(node, ast.ImportFrom)]
    declared = {alias.name: node.module for node in imports for alias in node.names}
    assert declared == {name: home for home, names in package._HOMES.items() for name in names}
    assert ast.unparse(tree.body[-1]) == f"__all__ = {package.__all__}"
    assert all(getattr(package, name) for name in declared)


@pytest.mark.parametrize("package", PACKAGES)
def test_a_name_that_a_package_does_not_have_is_an_attribute_error(package: ModuleType) -> None:
    with pytest.raises(AttributeError, match=f"module `{package.__name__}` has no `nothing`"):
        _ = package.nothing
