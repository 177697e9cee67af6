"""Each code of lint: declared once, beside its check, so that a search finds all its uses; and raised somewhere."""

import ast
from collections import Counter
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import lumen
from lumen.language.diagnostics import Severity, did_you_mean
from lumen.lint.codes import codes, families
from lumen.lint.pages import page
from tests.scanning import matching
from tests.tables import for_each

ENGINE = Path(lumen.__file__).parent
RAISING = (
    "expressions",
    "features/alerts",
    "features/answers",
    "features/console",
    "features/fleet",
    "features/reachy",
    "features/show",
    "features/simulation",
    "features/skills",
    "lint",
    "project",
    "run/reload",
)
FOREIGN = "project/formats"
"""Reports of imports, which are no findings of lint."""


def is_raising(file: str) -> bool:
    return file.startswith(RAISING) and not file.startswith(FOREIGN)


@cache
def trees() -> dict[str, ast.Module]:
    return {str(f.relative_to(ENGINE)): ast.parse(f.read_text(encoding="utf-8")) for f in matching(ENGINE, "**/*.py")}


def declarations() -> Iterator[tuple[str, str, str]]:
    """Yield the file, constant and code of each declaration."""
    for file, tree in trees().items():
        for node in tree.body:
            match node:
                case ast.Assign(
                    targets=[ast.Name(constant)], value=ast.Call(ast.Name("Code"), [ast.Constant(code), *_])
                ):
                    yield file, constant, code


def texts(tree: ast.AST) -> Iterator[str]:
    yield from (n.value for n in ast.walk(tree) if isinstance(n, ast.Constant) and isinstance(n.value, str))


def test_every_code_is_declared_once_under_its_own_name() -> None:
    found = [(constant, code) for _, constant, code in declarations()]
    assert sorted(code for _, code in found) == sorted(codes())
    assert all(constant == code.upper().replace("-", "_") for constant, code in found)


def test_no_code_is_made_in_any_other_way() -> None:
    made = [n for tree in trees().values() for n in ast.walk(tree) if isinstance(n, ast.Call)]
    assert sum(isinstance(n.func, ast.Name) and n.func.id == "Code" for n in made) == len(codes())


def test_a_search_for_a_code_finds_its_declaration_only() -> None:
    """Checks that raise it use the declared value; `tab` and `falls` are words as well."""
    counted = Counter(t for f, tree in trees().items() if is_raising(f) for t in texts(tree) if t in codes())
    assert {code: n for code, n in counted.items() if n > 1 and "-" in code} == {}


def test_every_code_is_raised_somewhere() -> None:
    names = {
        n.id
        for file, tree in trees().items()
        if is_raising(file)
        for n in ast.walk(tree)
        if isinstance(n, ast.Name) and isinstance(n.ctx, ast.Load)
    }
    assert [code for _, constant, code in declarations() if constant not in names] == []


@for_each("code", codes().values())
def test_every_code_says_how_bad_it_is_and_what_it_means(code) -> None:
    assert isinstance(code.severity, Severity)
    assert code in families()[code.family]
    assert code.summary
    assert not code.summary.endswith(".")
    assert page(code).what


def test_the_hint_of_a_name_says_what_to_do_if_there_are_none() -> None:
    assert did_you_mean("door", [], "available:") == (
        "there are none yet: define one of this name, or delete the name here"
    )
