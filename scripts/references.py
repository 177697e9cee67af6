"""Find references to modules and files of the package in a text, and rewrite the text after they have moved.

Imports, and uses of an imported module, are found by syntax tree. A name in a string, a comment or a page is found by
its spelling, which is not certain: a routing key such as `lumen.state` can look like a module.
"""

import ast
import re
from collections.abc import Iterable, Iterator, Mapping
from copy import copy
from pathlib import PurePosixPath
from typing import NamedTuple

PACKAGE = "engine/lumen"
ROOT_NAME = PurePosixPath(PACKAGE).name
BLOCK = re.compile(r"(?m)^```python\b.*\n([\s\S]*?)^```$")
"""A block of Python in a page."""
DOTTED = re.compile(rf"(?<![\w./-]){ROOT_NAME}(?:\.\w+)+")
PATH = re.compile(rf"(?<![\w./-])((?:\.\./)*{PACKAGE}/)?(\w[\w.-]*(?:/[\w.-]+)*)")
FROM = re.compile(r"from\s+([\w.]+)\s+import")


class Edit(NamedTuple):
    """A replacement for a part of a text."""

    start: int
    end: int
    text: str


class Moved:
    """The new paths of moved files, and of folders that move as a whole, by their old paths below the package.

    `known` are the paths of all files before the move. If another module gets the name of one that moves, that name
    stays unchanged everywhere: the new module offers what the old one did. `offered` are names like `lumen.life.vigour`
    that packages define themselves, and that are therefore not modules, although a file may have that name.
    """

    def __init__(
        self, files: Mapping[str, str], folders: Mapping[str, str], known: Iterable[str], offered: Iterable[str] = ()
    ) -> None:
        self.paths = {**folders, **files}
        self.known = {*known, *self.paths}
        self.known_modules = {module for path in self.known if (module := module_of(path))}
        self.offered = {*offered}
        named = {module_of(old): module_of(new) for old, new in files.items()}
        named_modules = {old: new for old, new in named.items() if old and new}
        self._reused = {old: new for old, new in named_modules.items() if old in named_modules.values()}
        self.modules = {old: new for old, new in named_modules.items() if old not in self._reused}

    def for_file(self, new_path: str) -> "Moved":
        """Return the moves for a file that moves to this path: a name that it gets has another meaning inside it."""
        seen, module = copy(self), module_of(new_path)
        if module in self._reused:
            seen.modules = {**self.modules, module: self._reused[module]}
        return seen

    def module(self, name: str) -> str:
        """Return the new name of a module."""
        return self.modules.get(name, name)


def module_of(path: str) -> str | None:
    """Return the module of a file below the package; None for other files."""
    file = PurePosixPath(path)
    if file.suffix not in (".py", ".pyi"):
        return None
    return ".".join([ROOT_NAME, *file.with_suffix("").parts]).removesuffix(".__init__")


def rewritten(text: str, edits: Iterable[Edit]) -> str:
    """Return the text with these edits, of which no two overlap."""
    for start, end, other in sorted(edits, reverse=True):
        text = text[:start] + other + text[end:]
    return text


def code_edits(text: str, moved: Moved) -> list[Edit]:
    """Return the edits of imports, of dotted names and of types in quotes. Raises SyntaxError for other text."""
    tree, places = ast.parse(text), _Places(text)
    found: list[Edit] = []
    for node in ast.walk(tree):
        match node:
            case ast.ImportFrom(level=0):
                found += _import_from(node, places, moved)
            case ast.Import():
                found += [places.edit(alias, _as(moved.module(alias.name), alias.asname)) for alias in node.names]
            case ast.Attribute() if (name := _dotted(node)) in moved.known_modules:
                found.append(places.edit(node, moved.module(name)))
            case ast.arg(annotation=type_) | ast.AnnAssign(annotation=type_) if type_:
                found += _in_quotes(type_, places, moved)
            case ast.FunctionDef(returns=type_) | ast.AsyncFunctionDef(returns=type_) if type_:
                found += _in_quotes(type_, places, moved)
    return [edit for edit in _outermost(found) if text[edit.start : edit.end] != edit.text]


def _outermost(edits: Iterable[Edit]) -> Iterator[Edit]:
    """Leave out the edits within others: `lumen.a` within `lumen.a.b`."""
    end = -1
    for edit in sorted(edits, key=lambda edit: (edit.start, -edit.end)):
        if edit.end > end:
            yield edit
            end = edit.end


def page_edits(text: str, moved: Moved) -> list[Edit]:
    """Return the edits of the blocks of Python in a page; a block that can't be parsed has none."""
    found: list[Edit] = []
    for block in BLOCK.finditer(text):
        try:
            edits = code_edits(block[1], moved)
        except SyntaxError:
            continue
        found += [Edit(start + block.start(1), end + block.start(1), other) for start, end, other in edits]
    return found


def spelled_edits(text: str, moved: Moved, but: Iterable[Edit] = ()) -> list[Edit]:
    """Return the edits of names spelled like a moved module, file or folder, except inside other edits."""
    others = list(but)
    found = [
        *(edit for match in DOTTED.finditer(text) if (edit := _spelled_module(match, moved))),
        *(edit for match in PATH.finditer(text) if (edit := _spelled_path(match, moved))),
    ]
    return [edit for edit in found if not any(edit.start < one.end and one.start < edit.end for one in others)]


def _spelled_module(match: re.Match[str], moved: Moved) -> Edit | None:
    name = match[0]
    while name and name not in moved.known_modules and name not in moved.modules:
        name = name.rpartition(".")[0]
    return Edit(match.start(), match.start() + len(name), moved.modules[name]) if name in moved.modules else None


def _spelled_path(match: re.Match[str], moved: Moved) -> Edit | None:
    """Follow a path of a moved file or folder; one of a single word only counts below `engine/lumen/`."""
    path = match[2].rstrip(".")
    while path and path not in moved.known and path not in moved.paths:
        path = path.rpartition("/")[0]
    if path not in moved.paths or not (match[1] or "/" in path):
        return None
    return Edit(match.start(2), match.start(2) + len(path), moved.paths[path])


class _Places:
    """Offsets of tree nodes in a text; the columns of the nodes count bytes."""

    def __init__(self, text: str) -> None:
        self.text = text
        self._lines = text.split("\n")
        self._starts = [0]
        for line in self._lines:
            self._starts.append(self._starts[-1] + len(line) + 1)

    def offset(self, line: int, column: int) -> int:
        row = self._lines[line - 1]
        return self._starts[line - 1] + (column if row.isascii() else len(row.encode()[:column].decode()))

    def span(self, node: ast.stmt | ast.expr | ast.alias) -> tuple[int, int]:
        last, column = node.end_lineno or node.lineno, node.end_col_offset or 0
        return self.offset(node.lineno, node.col_offset), self.offset(last, column)

    def edit(self, node: ast.stmt | ast.expr | ast.alias, text: str) -> Edit:
        return Edit(*self.span(node), text)


def _dotted(node: ast.expr) -> str | None:
    """Return `a.b.c` of an attribute of an attribute of a name; None for other expressions."""
    match node:
        case ast.Name(id=name):
            return name
        case ast.Attribute(value=value, attr=attribute) if owner := _dotted(value):
            return f"{owner}.{attribute}"
    return None


def _as(name: str, other: str | None) -> str:
    return f"{name} as {other}" if other else name


def _import_from(node: ast.ImportFrom, places: _Places, moved: Moved) -> Iterator[Edit]:
    """Follow the names of an import: modules to their new places, the others with their module."""
    homes: dict[str, list[str]] = {}
    source = node.module or ""
    for alias in node.names:
        module = f"{source}.{alias.name}"
        if module not in moved.known_modules or module in moved.offered:
            home, name = moved.module(source), alias.name
        else:
            home, _, name = moved.module(module).rpartition(".")
        renamed = alias.asname or (alias.name if name != alias.name else None)
        homes.setdefault(home, []).append(_as(name, renamed))
    start, end = places.span(node)
    statement = places.text[start:end]
    written = FROM.match(statement)
    assert written, statement
    if list(homes.values()) == [[_as(alias.name, alias.asname) for alias in node.names]]:
        yield Edit(start + written.start(1), start + written.end(1), next(iter(homes)))
    elif "#" in statement:
        raise ValueError(f"split this import by hand, since it has a comment:\n{statement}")
    else:
        lines = (f"from {home} import {', '.join(names)}" for home, names in homes.items())
        yield Edit(start, end, ("\n" + " " * node.col_offset).join(lines))


def _in_quotes(annotation: ast.expr, places: _Places, moved: Moved) -> Iterator[Edit]:
    """Follow moved modules inside the quoted parts of an annotation."""
    for node in ast.walk(annotation):
        if isinstance(node, ast.Constant) and isinstance(node.value, str):
            start, end = places.span(node)
            for edit in spelled_edits(places.text[start:end], moved):
                yield Edit(edit.start + start, edit.end + start, edit.text)
