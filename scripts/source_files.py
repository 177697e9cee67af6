"""Python files as trees, and walks through their statements."""

import ast
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import NamedTuple


class SourceFile(NamedTuple):
    """A Python file of the package."""

    path: str
    module: str
    text: str
    tree: ast.Module

    @property
    def lines(self) -> int:
        """Return the number of lines."""
        return len(self.text.splitlines())


def read(package: Path) -> list[SourceFile]:
    """Return the Python files below a folder, in the order of their paths; raise SyntaxError for an invalid one."""
    if not (files := sorted(package.rglob("*.py"))):
        raise SystemExit(f"no Python file is beneath {package}: the shape of nothing is not checked")
    return [_source_file(package, path) for path in files]


def _source_file(package: Path, path: Path) -> SourceFile:
    beneath, text = path.relative_to(package), path.read_text(encoding="utf-8")
    module = ".".join([package.name, *beneath.with_suffix("").parts]).removesuffix(".__init__")
    return SourceFile(beneath.as_posix(), module, text, ast.parse(text, str(path)))


def statements(parent: ast.AST) -> Iterator[ast.AST]:
    """Yield the statements below a node, at any depth; faster than `ast.walk`, which also visits expressions."""
    for node in ast.iter_child_nodes(parent):
        if isinstance(node, ast.stmt | ast.excepthandler | ast.match_case):
            yield node
            yield from statements(node)


def top_level(body: Iterable[ast.stmt]) -> Iterator[ast.stmt]:
    """Yield the statements of a module, including those under an `if` or a `try`."""
    for node in body:
        yield node
        if isinstance(node, ast.If | ast.Try):
            yield from top_level([*node.body, *node.orelse])
