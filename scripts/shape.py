"""Prints the shape of the house, from its code alone: `python scripts/shape.py [--markdown | --json]`.

    python scripts/shape.py --write docs/architecture.md    puts the table between the markers of a page
    python scripts/shape.py --check docs/architecture.md    fails where that table is no longer true
    python scripts/shape.py --action say                    the files that know an action
    python scripts/shape.py --commit HEAD                   the files that a commit touched
    python scripts/shape.py --list "seam probes"            the places that a figure of the architecture counts
    python scripts/shape.py --of ../before                  these figures, beside those of another checkout

What is counted are the Python files of the package, by what stands in them; nothing is imported. Sizes are lines as an
editor counts them: a function's from its `def` to its end, its docstring included. Paths are beneath the package.
"""

import argparse
import ast
import gc
import json
import re
import subprocess
import sys
import tomllib
from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass
from enum import StrEnum
from pathlib import Path
from statistics import median_low
from typing import NamedTuple

from features import elsewhere_by_feature
from figures import Figure, compared, figures, values
from source_files import SourceFile, read, statements, top_level

ROOT = Path(__file__).parents[1]
PACKAGE = "engine/lumen"

MAX_SHARING_FILES = 3
"""Constants and file names shared by more files than this are listed."""

SHOWN_ACTION = "leds"
"""The action whose files are counted by default."""

TOP_LEVEL = "top-level files"
"""The files in the package itself, outside of any floor's folder."""

BEGIN, END = "<!-- shape: written by scripts/shape.py -->\n", "<!-- end of shape -->"

_CONSTANT = re.compile(r"[A-Z][A-Z0-9_]+")
_TYPE_NAME = re.compile(r"_?[A-Z]\w*[a-z]\w*")
_DOTTED = re.compile(r"[\w.]+")
_WORD = re.compile(r"[A-Z]?[a-z0-9]+|[A-Z]+(?![a-z])")


class When(StrEnum):
    """The time at which an import happens."""

    LOADING = "at loading"
    LATE = "in a function"
    TYPES = "for types"


class Import(NamedTuple):
    """An import of one file of the package by another."""

    source: str
    target: str
    when: When


@dataclass(frozen=True, slots=True, order=True)
class Size:
    """The number of lines of something."""

    lines: int
    name: str


@dataclass(frozen=True, slots=True)
class Floor:
    """A folder of the package, with everything in it."""

    name: str
    files: int
    lines: int


@dataclass(frozen=True, slots=True)
class Shape:
    """The figures. Names that several files share are listed with those files; `circles` by the imports that count."""

    floors: list[Floor]
    median_file: int
    largest_file: Size
    median_function: int
    largest_function: Size
    repeated_types: dict[str, list[str]]
    repeated_private_types: dict[str, list[str]]
    repeated_constants: dict[str, list[str]]
    repeated_file_names: dict[str, list[str]]
    circles: dict[str, list[list[str]]]
    arrows_up: list[str]
    action: str
    action_files: list[str]


def floor_order(pyproject: str) -> list[set[str]]:
    """Return the content of each floor, from the top: the first contract of layers in the text of a pyproject.toml."""
    contracts = tomllib.loads(pyproject)["tool"]["importlinter"]["contracts"]
    layers = next(contract["layers"] for contract in contracts if contract["type"] == "layers")
    return [{name.strip(" ()").partition(".")[2] for name in row.split("|")} for row in layers]


def floors(files: Iterable[SourceFile], order: Sequence[set[str]]) -> list[Floor]:
    """Return files and lines of each floor from the top; other folders, and single files, come last."""
    found: dict[str, list[int]] = defaultdict(list)
    for file in files:
        found[file.path.split("/")[0] if "/" in file.path else TOP_LEVEL].append(file.lines)
    names = [name for row in order for name in sorted(row) if name in found]
    names += [name for name in found if name not in names]
    return [Floor(name, len(found[name]), sum(found[name])) for name in names]


def file_sizes(files: Iterable[SourceFile]) -> list[Size]:
    """Return the files by their lines, smallest first, without empty ones."""
    return sorted(Size(file.lines, file.path) for file in files if file.lines)


def function_sizes(files: Iterable[SourceFile]) -> list[Size]:
    """Return the functions and methods by their lines, smallest first."""
    return sorted(
        Size((node.end_lineno or node.lineno) - node.lineno + 1, f"{node.name} in {file.path}")
        for file in files
        for node in statements(file.tree)
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef)
    )


def type_names(file: SourceFile) -> set[str]:
    """Return the classes and the aliases of types at a file's top level."""
    classes = {node.name for node in top_level(file.tree.body) if isinstance(node, ast.ClassDef)}
    return classes | {name for name in _assigned(file, aliases=True) if _TYPE_NAME.fullmatch(name)}


def constants(file: SourceFile) -> set[str]:
    """Return the public constants at a file's top level."""
    return {name for name in _assigned(file) if _CONSTANT.fullmatch(name)}


def _assigned(file: SourceFile, *, aliases: bool = False) -> Iterator[str]:
    """Yield the names assigned at a file's top level; with `aliases`, those that may be types."""
    for node in top_level(file.tree.body):
        if isinstance(node, ast.Assign | ast.AnnAssign) and not (aliases and _is_made(node.value)):
            targets = node.targets if isinstance(node, ast.Assign) else [node.target]
            parts = (part for target in targets for part in ast.walk(target))
            yield from (part.id for part in parts if isinstance(part, ast.Name) and isinstance(part.ctx, ast.Store))


def _is_made(value: ast.expr | None) -> bool:
    """Return True if a value is the result of a call, such as a TypeVar; a NewType counts as a type."""
    return isinstance(value, ast.Call) and not (isinstance(value.func, ast.Name) and value.func.id == "NewType")


def shared(
    names: Callable[[SourceFile], Iterable[str]], files: Iterable[SourceFile], most: int
) -> dict[str, list[str]]:
    """Return the names that more than `most` files have, with those files."""
    found: dict[str, list[str]] = defaultdict(list)
    for file in files:
        for name in names(file):
            found[name].append(file.path)
    return {name: found[name] for name in sorted(found) if len(found[name]) > most}


def file_name(file: SourceFile) -> list[str]:
    """Return the base name of a file; empty for special names such as `__init__.py`."""
    name = file.path.rpartition("/")[2]
    return [] if name.startswith("__") else [name]


def imports(files: Sequence[SourceFile]) -> list[Import]:
    """Return the imports between files, as written: the implicit import of a parent package does not count."""
    paths = {file.module: file.path for file in files}
    return sorted(
        {
            Import(file.path, paths[module], when)
            for file in files
            for node, when in _import_statements(file.tree.body)
            for module in _imported(node, paths)
        }
    )


def _import_statements(
    body: Iterable[ast.AST], when: When = When.LOADING
) -> Iterator[tuple[ast.Import | ast.ImportFrom, When]]:
    """Yield the imports in these statements, at any depth, each with its time."""
    for node in body:
        if isinstance(node, ast.Import | ast.ImportFrom):
            yield node, when
        elif isinstance(node, ast.If) and ast.unparse(node.test).endswith("TYPE_CHECKING"):
            yield from _import_statements(node.body, When.TYPES)
            yield from _import_statements(node.orelse, when)
        elif isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            yield from _import_statements(node.body, When.LATE)
        elif isinstance(node, ast.stmt | ast.excepthandler | ast.match_case):
            yield from _import_statements(ast.iter_child_nodes(node), when)


def _imported(node: ast.Import | ast.ImportFrom, modules: Iterable[str]) -> Iterator[str]:
    """Yield those of the modules that a statement imports; for `from a import b`, `a.b` if that is one, else `a`."""
    for alias in node.names:
        parent = node.module if isinstance(node, ast.ImportFrom) else None
        yield from [name for name in (f"{parent}.{alias.name}", parent or alias.name) if name in modules][:1]


def circles(arrows: Iterable[Import], counted: Iterable[When]) -> list[list[str]]:
    """Return the groups of files in which each reaches every other, largest first."""
    targets: dict[str, set[str]] = defaultdict(set)
    for arrow in arrows:
        if arrow.when in counted and arrow.source != arrow.target:
            targets[arrow.source].add(arrow.target)
    reached = {file: _reached(file, targets) for file in list(targets)}
    groups = {frozenset(b for b in reached[a] if a in reached.get(b, ())) for a in reached if a in reached[a]}
    return sorted((sorted(group) for group in groups), key=lambda group: (-len(group), group))


def _reached(file: str, targets: Mapping[str, set[str]]) -> set[str]:
    found: set[str] = set()
    waiting = [file]
    while waiting:
        new = targets.get(waiting.pop(), set()) - found
        found |= new
        waiting += new
    return found


def arrows_up(arrows: Iterable[Import], order: Sequence[set[str]]) -> list[str]:
    """Return the imports, at any time, of a floor above the own one or beside it."""
    rank = {name: number for number, row in enumerate(order) for name in row}
    found = []
    for arrow in arrows:
        source, target = (path.split("/")[0].removesuffix(".py") for path in arrow[:2])
        if source != target and rank.get(source, -1) >= rank.get(target, len(order)):
            found.append(f"{arrow.source} -> {arrow.target} ({arrow.when})")
    return found


def action_files(files: Iterable[SourceFile], action: str) -> list[str]:
    """Return the files that name an action, in a word of an identifier or of a text that consists of names."""
    return [file.path for file in files if action in file.text.lower() and action in _words(file.tree)]


def _words(tree: ast.Module) -> set[str]:
    """Return the words, in small letters, of all names in a file, equal for `SayText`, `say_text`, `"say.text"`."""
    values = (value for node in ast.walk(tree) for _, value in ast.iter_fields(node))
    names = {value for value in values if isinstance(value, str) and _DOTTED.fullmatch(value)}
    return {word.lower() for name in names for word in _WORD.findall(name)}


def commit_files(root: Path, commit: str) -> list[str]:
    """Return the Python files of the package that a commit touched; raise CalledProcessError for an unknown commit."""
    command = ["git", "show", "--name-only", "--format=", commit, "--", PACKAGE]
    names = subprocess.run(command, cwd=root, capture_output=True, text=True, check=True).stdout.split("\n")
    return [name.removeprefix(f"{PACKAGE}/") for name in names if name.endswith(".py")]


def measure(files: Sequence[SourceFile], order: Sequence[set[str]], action: str = SHOWN_ACTION) -> Shape:
    """Return all figures of the files of a package, with its floors in order from the top."""
    by_file, by_function, arrows = file_sizes(files), function_sizes(files), imports(files)
    types = shared(type_names, files, 1)
    counted = [[When.LOADING], [When.LOADING, When.TYPES], [When.LOADING, When.LATE], list(When)]
    return Shape(
        floors=floors(files, order),
        median_file=median_low(size.lines for size in by_file),
        largest_file=by_file[-1],
        median_function=median_low(size.lines for size in by_function),
        largest_function=by_function[-1],
        repeated_types={name: where for name, where in types.items() if not name.startswith("_")},
        repeated_private_types={name: where for name, where in types.items() if name.startswith("_")},
        repeated_constants=shared(constants, files, MAX_SHARING_FILES),
        repeated_file_names=shared(file_name, files, MAX_SHARING_FILES),
        circles={" + ".join(whens): circles(arrows, whens) for whens in counted},
        arrows_up=arrows_up(arrows, order),
        action=action,
        action_files=action_files(files, action),
    )


def report(shape: Shape) -> str:
    """Return all figures as text, with the names behind them."""
    sizes = [
        f"{floor.name:<16}{floor.files:>5} files {floor.lines:>7} lines" for floor in (*shape.floors, total(shape))
    ]
    file, function, most = shape.largest_file, shape.largest_function, MAX_SHARING_FILES
    parts = [
        *sizes,
        f"median file {shape.median_file} lines, largest {file.lines}: {file.name}",
        f"median function {shape.median_function} lines, largest {function.lines}: {function.name}",
        _several("public types defined in more than one file", shape.repeated_types),
        _several("private types defined in more than one file", shape.repeated_private_types),
        _several(f"public constants defined in more than {most} files", shape.repeated_constants),
        _several(f"names of more than {most} files", shape.repeated_file_names),
        *(_listed(f"circles, imports {whens}", map(" ".join, found)) for whens, found in shape.circles.items()),
        _listed("imports up the floors or across", shape.arrows_up),
        _listed(f"files that name `{shape.action}`, for whatever reason", shape.action_files),
    ]
    return "\n".join(parts)


def _several(title: str, names: Mapping[str, Sequence[str]]) -> str:
    return _listed(title, (f"{name} ({len(files)}): {', '.join(files)}" for name, files in names.items()))


def _listed(title: str, items: Iterable[str]) -> str:
    lines = [f"  {item}" for item in items]
    return "\n".join([f"{title}: {len(lines)}", *lines])


def total(shape: Shape) -> Floor:
    """Return all floors as one."""
    return Floor("together", sum(floor.files for floor in shape.floors), sum(floor.lines for floor in shape.floors))


def table(shape: Shape) -> str:
    """Return the figures for the docs, in Markdown; lines are rounded, so that small changes don't make them stale."""
    most, every = MAX_SHARING_FILES, " + ".join(When)
    rows = [
        *((f"`{floor.name}`", f"{floor.files} files, {rounded(floor.lines):,} lines") for floor in shape.floors),
        ("together", f"{total(shape).files} files, {rounded(total(shape).lines):,} lines"),
        ("a file", f"median {shape.median_file} lines, largest {_size(shape.largest_file)}"),
        ("a function", f"median {shape.median_function} lines, largest {_size(shape.largest_function)}"),
        ("public types of the same name", f"{len(shape.repeated_types)}"),
        (f"constants of the same name in more than {most} files", f"{len(shape.repeated_constants)}"),
        (f"file names used more than {most} times", f"{len(shape.repeated_file_names)}"),
        ("circles of imports, type-only and late ones counted", f"{len(shape.circles[every])}"),
        ("imports up the floors", f"{len(shape.arrows_up)}"),
        (f"files that name `{shape.action}`, for whatever reason", f"{len(shape.action_files)}"),
    ]
    return "".join(f"| {name} | {figure} |\n" for name, figure in [("what", "how much"), ("---", "---"), *rows])


def _size(size: Size) -> str:
    return f"{rounded(size.lines)} (`{size.name}`)"


def rounded(number: int) -> int:
    """Return a number rounded to two significant digits."""
    return int(float(f"{number:.2g}"))


def placed(page: str, text: str) -> str:
    """Return a page with the text between its markers; raise ValueError if it has none."""
    before, begin, rest = page.partition(BEGIN)
    _, end, after = rest.partition(END)
    if not end:
        raise ValueError(f"the page has no lines {BEGIN.strip()} and {END}")
    return f"{before}{begin}{text}{end}{after}"


def main(arguments: Sequence[str] | None = None) -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--root", type=Path, default=ROOT, help="another checkout")
    parser.add_argument("--action", default=SHOWN_ACTION, help="count the files that know this action")
    parser.add_argument("--commit", help="only count the files of the package that this commit touched")
    output = parser.add_mutually_exclusive_group()
    output.add_argument("--markdown", action="store_true", help="the table for the docs")
    output.add_argument("--json", action="store_true", help="all figures and names")
    output.add_argument("--write", type=Path, metavar="PAGE", help="put the table into a page")
    output.add_argument("--check", type=Path, metavar="PAGE", help="fail where the table of a page is stale")
    output.add_argument("--list", metavar="NAME", help="print the places that this figure of the architecture counts")
    output.add_argument("--of", type=Path, metavar="PATH", help="print these figures beside those of another checkout")
    asked = parser.parse_args(arguments)
    if asked.commit:
        print(_listed(f"Python files of the package in {asked.commit}", commit_files(asked.root, asked.commit)))
        return
    files = read(asked.root / PACKAGE)
    if asked.list:
        print(_places(asked.list, figures(files)))
    elif asked.of:
        print(compared(read(asked.of / PACKAGE), files))
    else:
        order = floor_order((asked.root / "pyproject.toml").read_text(encoding="utf-8"))
        _report(measure(files, order, asked.action), files, asked)


def _report(shape: Shape, files: Sequence[SourceFile], asked: argparse.Namespace) -> None:
    """Print the figures, or write them, in the requested form."""
    if page := asked.write or asked.check:
        _keep(page, table(shape), only_check=asked.check is not None)
    elif asked.json or asked.markdown:
        print(json.dumps(asdict(shape), indent=2) if asked.json else table(shape))
    else:
        print(f"{report(shape)}\n{_elsewhere(files)}\n\n{values(figures(files))}")


def _elsewhere(files: Sequence[SourceFile]) -> str:
    """Return a line for each feature: its files outside of its folder."""
    found = elsewhere_by_feature(files)
    return _listed(
        "features, each with its files elsewhere", (f"{n}: {', '.join(p) or 'none'}" for n, p in found.items())
    )


def _places(name: str, found: Mapping[str, Figure]) -> str:
    if name not in found:
        sys.exit(f"no figure `{name}`: choose one of {', '.join(found)}")
    return "\n".join([f"{name}: {found[name].value:,}", *(f"  {each}" for each in found[name].counted)])


def _keep(page: Path, text: str, *, only_check: bool) -> None:
    """Put the table into a page, or exit with a message if the page differs."""
    now = page.read_text(encoding="utf-8")
    new = placed(now, text)
    if only_check and now != new:
        sys.exit(f"{page} is stale: run `python scripts/shape.py --write {page}`")
    if not only_check:
        page.write_text(new, encoding="utf-8")


if __name__ == "__main__":
    gc.disable()  # the trees live until the end: garbage collection would take two fifths of the time
    main()
