"""Python files as trees, and walks through their statements."""

import ast
from collections import defaultdict
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TypeVar, cast

N = TypeVar("N", bound=ast.AST)


@dataclass(frozen=True, eq=False)
class SourceFile:
    """A Python file of the package, and an index of its nodes."""

    path: str
    module: str
    text: str
    tree: ast.Module

    @property
    def lines(self) -> int:
        """Return the number of lines."""
        return len(self.text.splitlines())

    def of(self, *kinds: type[N]) -> Iterator[N]:
        """Yield the nodes of these kinds at any depth, one kind after another; the tree is walked once for all."""
        return (cast(N, node) for kind in kinds for node in self._nodes.get(kind, ()))

    @cached_property
    def _nodes(self) -> dict[type[ast.AST], list[ast.AST]]:
        found: dict[type[ast.AST], list[ast.AST]] = defaultdict(list)
        for node in ast.walk(self.tree):
            found[type(node)].append(node)
        return dict(found)


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
