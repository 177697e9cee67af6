"""Find the lists of a package that every addition must edit: they name, one by one, things defined elsewhere.

- A *table* at the top level of a file: at least three rows that name functions, classes or modules of other files. A
  thing that all rows name makes the rows and does not count. Bare classes of one module are a union, not a table.
- *Names* at the top level of a file: at least three texts, of which four fifths name the modules of one folder.
- A *chain* in a function: branches that compare one value with constants, of which at least two return something and
  make objects of classes from different files.
- An *enumeration* of which at least three other files distinguish three or more members in one function or statement.

Lists to which no package could want to add anything are closed on purpose (`ON_PURPOSE`), and counted separately.
"""

import ast
import re
from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import cache
from typing import NamedTuple

from scopes import Function, Package, Place, Scoped, assigned, last_word
from source_files import SourceFile, top_level

ROWS = 3
"""A list of fewer rows is not counted."""
SHARE = 0.8
"""The part of a list's texts that must be modules of one folder."""
FILES = 3
"""An enumeration is closed if at least this many other files distinguish its members."""
CONSTANT = re.compile(r"_?[A-Z][A-Z0-9_]*")
CLASS = re.compile(r"_?[A-Z]\w*[a-z]\w*")

Things = Mapping[str, str]
"""The functions, classes and modules that a file imports from the package: the local name, and the module."""


ON_PURPOSE: Mapping[tuple[str, str], str] = {
    (
        "bus/checked_bus.py",
        "_VALUES",
    ): "abilities that Lumen asks a bus for; one that it does not know it never asks for",
    ("language/diagnostics.py", "Severity"): "the levels that the formats of editors, GitHub and SARIF have",
    ("language/machines.py", "StateKind"): "the kinds of states that the algorithm of SCXML has",
    ("language/routes.py", "Carried"): "promises that every bus keeps; a new one would break the buses of packages",
    ("language/verbs.py", "VERBS"): "typed verbs of every robot (decision 119); packages have rows `verbs`",
    (
        "features/editor/names.py",
        "NameKind",
    ): "the names in Lumen's own files; those in a package's rows come from its schemas",
    ("robot/command_table.py", "COMMANDS"): "a union that mypy checks (decision 119); packages have rows `verbs`",
}
"""The reason why a list stays closed, by its file and name."""


def closed_lists(package: Package) -> list[Place]:
    """Return the lists that must still be opened, in the order of the files."""
    return [place for place in _found(package) if _key(place) not in ON_PURPOSE]


def closed_on_purpose(package: Package) -> list[Place]:
    """Return the lists that stay closed, each with the reason."""
    found = [(place, ON_PURPOSE.get(_key(place))) for place in _found(package)]
    return [place._replace(why=f"{place.why.partition(':')[0]}: {reason}") for place, reason in found if reason]


def _key(place: Place) -> tuple[str, str]:
    """Return the file and the name of a list, as in `table VERBS: GoTo, Language`."""
    return place.path, place.why.partition(":")[0].rpartition(" ")[2]


@cache
def _found(package: Package) -> Sequence[Place]:
    """Return the lists of all four kinds, in the order of the files; one of two kinds counts once."""
    finders = (tables, names, chains, enumerations)
    found: dict[tuple[str, int], Place] = {}
    for place in (place for find in finders for place in find(package)):
        found.setdefault((place.path, place.line), place)
    return sorted(found.values())


def tables(package: Package) -> Iterator[Place]:
    """Yield each table: its rows name functions, classes or modules of other files."""
    imported = _imported(package)
    for row in _literals(package):
        things = imported[row.file.path]
        values = {name: value for name, value in _constants(row.file) if name != row.name}
        named = [_things(element, things, values) for element in row.elements]
        common = set.intersection(*named) if named else set()
        rows = [found - common for found in named if found - common]
        kinds = set().union(*rows)
        bare = all(isinstance(each, ast.Name) and CLASS.fullmatch(each.id) for each in row.keys)
        if len(rows) >= ROWS and len(kinds) > 1 and not (bare and len({things[kind] for kind in kinds}) == 1):
            yield Place(row.file.path, row.line, f"table {row.name}: {_some(kinds)}")


def names(package: Package) -> Iterator[Place]:
    """Yield each list whose texts name the modules of a folder."""
    folders: dict[str, set[str]] = defaultdict(set)
    for file in package.files:
        folder, _, name = file.path.removesuffix("/__init__.py").removesuffix(".py").rpartition("/")
        folders[folder].add(name)
    for row in _literals(package):
        texts = {each.value for each in row.keys if isinstance(each, ast.Constant) and isinstance(each.value, str)}
        for folder, modules in folders.items():
            found = {text for text in texts if text.replace("-", "_") in modules}
            if len(found) >= max(ROWS, SHARE * len(row.elements)):
                yield Place(row.file.path, row.line, f"names {row.name}: modules of {folder}/, {_some(found)}")
                break


def chains(package: Package) -> Iterator[Place]:
    """Yield each chain of branches that makes objects of classes from different files."""
    imported = _imported(package)
    branches: dict[tuple[int, str], list[list[ast.stmt]]] = defaultdict(list)
    around: dict[int, Scoped] = {
        id(scoped.node): scoped for scoped in package.of(ast.FunctionDef, ast.AsyncFunctionDef)
    }
    for scoped in package.of(ast.If, ast.Match):
        for value, body in _branches(scoped.node) if scoped.functions else ():
            branches[id(scoped.functions[-1]), value].append(body)
    for (function, value), bodies in branches.items():
        scoped, things = around[function], imported[around[function].file.path]
        made = [found for body in bodies if (found := _made(body, things))]
        kinds = set().union(*made)
        if len(made) > 1 and len({things[kind] for kind in kinds}) > 1:
            yield scoped.place(f"chain {scoped.node.name}: `{value}` chooses {_some(kinds)}")


def enumerations(package: Package) -> Iterator[Place]:
    """Yield each enumeration whose members several other files distinguish."""
    members = {
        name: {last_word(target) for node in kind.node.body if isinstance(node, ast.Assign) for target in node.targets}
        for name, (kind, *_) in package.classes.items()
        if any(last_word(base) in ("Enum", "StrEnum", "IntEnum") for base in kind.node.bases)
    }
    told: dict[str, set[str]] = defaultdict(set)
    for file in package.files:
        named = {name for name in members if name in file.text and file != package.classes[name][0].file}
        named &= _distinguished(members, file.of(ast.Attribute))
        for node in _separate(file) if named else ():
            for name in named & _distinguished(members, ast.walk(node)):
                told[name].add(file.path)
    for name, files in told.items():
        if len(files) >= FILES:
            yield package.classes[name][0].place(f"enumeration {name}: told apart in {_some(files)}")


def _distinguished(members: Mapping[str, set[str]], nodes: Iterable[ast.AST]) -> set[str]:
    """Return the enumerations of which these nodes name enough members."""
    found: dict[str, set[str]] = defaultdict(set)
    for each in nodes:
        if isinstance(each, ast.Attribute) and isinstance(each.value, ast.Name):
            found[each.value.id].add(each.attr)
    return {name for name, its in members.items() if len(found[name] & its) >= ROWS}


class _Literal(NamedTuple):
    """A tuple, list, set or table at the top level of a file."""

    file: SourceFile
    line: int
    name: str
    keys: list[ast.expr]
    elements: list[ast.expr]


def _literals(package: Package) -> Iterator[_Literal]:
    for file in package.files:
        for name, value in _constants(file):
            if isinstance(value, ast.Call) and value.args:  # frozenset({…}), MappingProxyType({…})
                value = value.args[0]
            if isinstance(value, ast.Dict):
                keys = [key or row for key, row in zip(value.keys, value.values, strict=True)]
                rows: list[ast.expr] = [ast.Tuple([*pair], ast.Load()) for pair in zip(keys, value.values, strict=True)]
                yield _Literal(file, value.lineno, name, keys, rows)
            elif isinstance(value, ast.Tuple | ast.List | ast.Set):
                yield _Literal(file, value.lineno, name, value.elts, value.elts)


def _constants(file: SourceFile) -> Iterator[tuple[str, ast.expr]]:
    """Yield the names assigned at a file's top level, with their values; of `A, B = C = …` the last name."""
    for node in top_level(file.tree.body):
        if isinstance(node, ast.Assign | ast.AnnAssign) and node.value:
            pairs = [(target.id, value) for target, value in assigned(node) if isinstance(target, ast.Name) and value]
            yield from pairs


def _imported(package: Package) -> dict[str, dict[str, str]]:
    """Return the things of the package that each file imports, by file."""
    found: dict[str, dict[str, str]] = defaultdict(dict)
    modules = {file.module for file in package.files}
    for scoped in package.of(ast.ImportFrom):
        module = scoped.node.module or ""
        if module.partition(".")[0] == scoped.file.module.partition(".")[0]:
            for alias in scoped.node.names:
                if not CONSTANT.fullmatch(alias.name):
                    whole = f"{module}.{alias.name}"
                    found[scoped.file.path][alias.asname or alias.name] = whole if whole in modules else module
    return found


def _things(row: ast.expr, things: Things, values: Mapping[str, ast.expr]) -> set[str]:
    """Return the things that a row names, directly or by a constant of its file."""
    found = set()
    for each in ast.walk(row):
        if isinstance(each, ast.Name) and each.id in things:
            found.add(each.id)
        elif isinstance(each, ast.Name) and each.id in values:
            found |= {name.id for name in ast.walk(values[each.id]) if isinstance(name, ast.Name) and name.id in things}
    return found


def _branches(node: ast.If | ast.Match) -> Iterator[tuple[str, list[ast.stmt]]]:
    """Yield the bodies of the branches that compare a value with constants, each with that value."""
    if isinstance(node, ast.If):
        values = {_compared(test) for test in ast.walk(node.test)} - {""}
        yield from ((value, node.body) for value in values)
    else:
        compared = (case for case in node.cases if isinstance(case.pattern, ast.MatchValue | ast.MatchOr))
        yield from ((ast.unparse(node.subject), case.body) for case in compared)


def _compared(test: ast.AST) -> str:
    """Return the value that a test compares with a constant, or searches among constants."""
    match test:
        case ast.Compare(left=left, ops=[ast.Eq() | ast.In()], comparators=[right]) if _is_constant(right):
            return ast.unparse(left)
    return ""


def _is_constant(value: ast.expr) -> bool:
    if isinstance(value, ast.Tuple | ast.Set | ast.List):
        return all(map(_is_constant, value.elts))
    return isinstance(value, ast.Constant) or bool(CONSTANT.fullmatch(last_word(value)))


def _made(body: Iterable[ast.stmt], things: Things) -> set[str]:
    """Return the imported classes, except exceptions, of which a branch makes objects; empty if it returns nothing."""
    nodes = [each for node in body for each in ast.walk(node)]
    if not any(isinstance(each, ast.Return) and each.value for each in nodes):
        return set()
    calls = (each for each in nodes if isinstance(each, ast.Call))
    found = {each.func.id for each in calls if isinstance(each.func, ast.Name) and each.func.id in things}
    return {name for name in found if CLASS.fullmatch(name) and not name.endswith("Error")}


def _separate(file: SourceFile) -> Iterator[ast.AST]:
    """Yield the functions of a file, and its other statements."""
    yield from file.of(ast.FunctionDef)
    yield from file.of(ast.AsyncFunctionDef)
    yield from (node for node in file.tree.body if not isinstance(node, ast.ClassDef | Function))


def _some(things: Iterable[str]) -> str:
    listed = sorted(things)
    return ", ".join(listed[:5]) + (f" and {len(listed) - 5} more" if len(listed) > 5 else "")
