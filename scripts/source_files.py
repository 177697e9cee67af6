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
        return len(self.text.splitlines())


def read(package: Path) -> list[SourceFile]:
    """The Python files beneath a folder, in the order of their paths; raises SyntaxError for one that is not Python."""
    if not (files := sorted(package.rglob("*.py"))):
        raise SystemExit(f"no Python file is beneath {package}: the shape of nothing is not checked")
    return [_source_file(package, path) for path in files]


def _source_file(package: Path, path: Path) -> SourceFile:
    beneath, text = path.relative_to(package), path.read_text(encoding="utf-8")
    module = ".".join([package.name, *beneath.with_suffix("").parts]).removesuffix(".__init__")
    return SourceFile(beneath.as_posix(), module, text, ast.parse(text, str(path)))


def statements(parent: ast.AST) -> Iterator[ast.AST]:
    """The statements beneath a node, at any depth; quicker than `ast.walk`, which looks into expressions, too."""
    for node in ast.iter_child_nodes(parent):
        if isinstance(node, ast.stmt | ast.excepthandler | ast.match_case):
            yield node
            yield from statements(node)


def top_level(body: Iterable[ast.stmt]) -> Iterator[ast.stmt]:
    """The statements of a module, those under an `if` or a `try` too."""
    for node in body:
        yield node
        if isinstance(node, ast.If | ast.Try):
            yield from top_level([*node.body, *node.orelse])
