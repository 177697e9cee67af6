"""The statements of a package, each with the class and the functions around it. Nothing is imported."""

import ast
import re
from collections import defaultdict
from collections.abc import Iterator, Sequence
from functools import cached_property
from typing import NamedTuple

from source_files import SourceFile

Function = ast.FunctionDef | ast.AsyncFunctionDef
KEPT = (ast.stmt, ast.Call)
LEAVES = (ast.Name, ast.Constant, ast.expr_context, ast.operator, ast.cmpop)
"""Nodes without statements or calls below."""
OWN = {"self", "cls"}


class Place(NamedTuple):
    """A line of a file, and the reason why it counts."""

    path: str
    line: int
    why: str

    def __str__(self) -> str:
        return f"{self.path}:{self.line}: {self.why}"


class Scoped(NamedTuple):
    """A statement or a call, its file, and the class and the functions around it, the innermost last."""

    node: ast.stmt | ast.Call
    file: SourceFile
    owner: ast.ClassDef | None
    functions: tuple[Function, ...]

    def place(self, why: str) -> Place:
        """Return the place of the node."""
        return Place(self.file.path, self.node.lineno, why)


class Package:
    """The files of a package, and an index of their statements and classes.

    Classes are identified by name: a public one has a unique name in the whole package (tests/house/test_house.py), and
    private ones of the same name count as one.
    """

    def __init__(self, files: Sequence[SourceFile]) -> None:
        self.files = files
        self._nodes: dict[type[ast.AST], list[Scoped]] = defaultdict(list)
        for file in files:
            self._enter(file.tree, file, None, ())

    def _enter(
        self, parent: ast.AST, file: SourceFile, owner: ast.ClassDef | None, functions: tuple[Function, ...]
    ) -> None:
        for node in ast.iter_child_nodes(parent):
            if isinstance(node, KEPT):
                self._nodes[type(node)].append(Scoped(node, file, owner, functions))
            if isinstance(node, ast.ClassDef):
                self._enter(node, file, node, ())
            elif isinstance(node, Function):
                self._enter(node, file, owner, (*functions, node))
            elif not isinstance(node, LEAVES):
                self._enter(node, file, owner, functions)

    def of(self, *kinds: type[ast.AST]) -> Iterator[Scoped]:
        """Return the nodes of these kinds, one kind after another, in the order of the files."""
        return (scoped for kind in kinds for scoped in self._nodes[kind])

    @cached_property
    def classes(self) -> dict[str, list[Scoped]]:
        """Return the classes by name."""
        found: dict[str, list[Scoped]] = defaultdict(list)
        for scoped in self.of(ast.ClassDef):
            found[scoped.node.name].append(scoped)
        return dict(found)

    def ancestors(self, name: str) -> list[str]:
        """Return the names of a class of the package and of those that it inherits from, nearest first."""
        found = [name] if name in self.classes else []
        for each in found:  # grows
            bases = (last_word(base) for scoped in self.classes[each] for base in scoped.node.bases)
            found += [base for base in bases if base in self.classes and base not in found]
        return found

    def family(self, root: str) -> set[str]:
        """Return the names of a class and of all that inherit from it; raise LookupError if there is no such class."""
        if root not in self.classes:
            raise LookupError(f"no class is named {root}: the figures that need it are not known")
        return {name for name in self.classes if root in self.ancestors(name)}


def last_word(expression: ast.expr) -> str:
    """Return the last name of a dotted one: `c` of `a.b.c` and of `a.b.c[int]`; empty for other expressions."""
    match expression:
        case ast.Name():
            return expression.id
        case ast.Attribute():
            return expression.attr
        case ast.Subscript():
            return last_word(expression.value)
        case ast.Constant(value=str(text)):
            return re.split(r"\W", text.partition("[")[0])[-1]
    return ""


def is_property(function: Function) -> bool:
    """Return True if a function is read, or written, like an attribute."""
    words = {last_word(decorator) for decorator in function.decorator_list}
    return bool(words & {"property", "cached_property", "setter"})


def parameters(function: Function) -> list[ast.arg]:
    """Return all parameters of a function, without the object or class to which a method belongs."""
    named = function.args
    found = [*named.posonlyargs, *named.args, named.vararg, *named.kwonlyargs, named.kwarg]
    return [parameter for parameter in found if parameter is not None and parameter.arg not in OWN]


def assigned(node: ast.Assign | ast.AnnAssign) -> Iterator[tuple[ast.expr, ast.expr | None]]:
    """Yield the targets of an assignment, each with its value; None if the value is unknown, as in `a, b = c`."""
    for target in node.targets if isinstance(node, ast.Assign) else [node.target]:
        if not isinstance(target, ast.Tuple):
            yield target, node.value
        elif isinstance(node.value, ast.Tuple) and len(node.value.elts) == len(target.elts):
            yield from zip(target.elts, node.value.elts, strict=True)
        else:
            yield from ((each, None) for each in target.elts)
