"""The figures of the architecture: the composition of an exhibition, and the lengths and widths of the code.

Each is counted by a rule from the code alone; the rules are in wiring.py, closed_lists.py, features.py and below.
tests/house checks them: ceilings.yaml lists the greatest allowed value of each.
"""

import ast
import re
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

from callables import Callables
from closed_lists import closed_lists, closed_on_purpose
from features import files_elsewhere, imports_by_core, imports_by_features, small_modules
from one_meaning import names_of_two_meanings
from scopes import Package, Place, parameters
from source_files import SourceFile, statements
from wiring import added_callables, assigned_callables, composition_sites, seam_probes, storing_methods

LONG = 50
"""Functions with more lines are listed."""
WIDE = 8
"""Functions with more parameters are counted, without the object or class to which a method belongs."""
STEPS = {"statements": 500}
"""The ceilings of these figures are multiples of a step, so that small changes of the code don't change them."""
CEILINGS = "tests/house/ceilings.yaml"
TOP_LEVEL = "top-level files"
NO_FORMAT = re.compile(r"#\s*fmt:\s*(skip|off)")


class Figure(NamedTuple):
    """A figure, and a line for each item that it counts."""

    value: int
    counted: Sequence[object]


def figures(files: Sequence[SourceFile]) -> dict[str, Figure]:
    """Return all figures by name. Raises LookupError if the package lacks the classes `Part` or `Node`."""
    package = Package(files)
    callables = Callables(package)
    long = sorted(long_functions(package), reverse=True)
    sizes = folder_sizes(files)
    return {
        "composition sites": _number(composition_sites(package)),
        "longest function": Figure(long[0][0], [f"{lines:>4} {place}" for lines, place in long if lines > LONG]),
        "seam probes": _number(seam_probes(package)),
        "assigned callables": _number(assigned_callables(package, callables)),
        "added callables": _number(added_callables(package, callables)),
        "storing methods": _number(storing_methods(package, callables)),
        "closed lists": _number(closed_lists(package)),
        "lists closed on purpose": _number(closed_on_purpose(package)),
        "imports of features by the core": _number(imports_by_core(files)),
        "imports of features by features": _number(imports_by_features(files)),
        "small modules with one reader": _number(small_modules(files)),
        "names of two meanings": _number(names_of_two_meanings(files)),
        "files of features elsewhere": _number(files_elsewhere(files)),
        "wide functions": _number(wide_functions(package)),
        "unformatted statements": _number(unformatted_statements(files)),
        "statements": Figure(sizes.total(), [f"{size:>7,} in {folder}" for folder, size in sizes.most_common()]),
    }


def _number(places: Iterable[Place]) -> Figure:
    found = sorted(places)
    return Figure(len(found), found)


def long_functions(package: Package) -> Iterator[tuple[int, Place]]:
    """Yield all functions, each with its number of lines from `def` to its end."""
    for scoped in package.of(ast.FunctionDef, ast.AsyncFunctionDef):
        lines = (scoped.node.end_lineno or scoped.node.lineno) - scoped.node.lineno + 1
        yield lines, scoped.place(scoped.node.name)


def wide_functions(package: Package) -> Iterator[Place]:
    """Yield the functions with more than `WIDE` parameters."""
    for scoped in package.of(ast.FunctionDef, ast.AsyncFunctionDef):
        if (number := len(parameters(scoped.node))) > WIDE:
            owner = f"{scoped.owner.name}." if scoped.owner else ""
            yield scoped.place(f"{owner}{scoped.node.name} has {number} parameters")


def unformatted_statements(files: Iterable[SourceFile]) -> Iterator[Place]:
    """Yield the lines that are excluded from formatting."""
    for file in files:
        for number, line in enumerate(file.text.splitlines(), 1):
            if NO_FORMAT.search(line):
                yield Place(file.path, number, line.strip())


def folder_sizes(files: Iterable[SourceFile]) -> Counter[str]:
    """Return the number of statements in each folder of the package; its own files are its `TOP_LEVEL`."""
    found: Counter[str] = Counter()
    for file in files:
        found[file.path.partition("/")[0] if "/" in file.path else TOP_LEVEL] += statement_count(file)
    return found


def statement_count(file: SourceFile) -> int:
    """Return the number of statements of a file, without imports and without bare texts, which are docstrings."""
    return sum(isinstance(node, ast.stmt) and not _is_uncounted(node) for node in statements(file.tree))


def _is_uncounted(node: ast.stmt) -> bool:
    text = isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant) and isinstance(node.value.value, str)
    return text or isinstance(node, ast.Import | ast.ImportFrom)


def beyond_ceilings(figures: Mapping[str, Figure], ceilings: Mapping[str, int]) -> list[str]:
    """Return the figures above their ceiling, with all items, and those below it, with the ceiling to write."""
    found = []
    for name in {**figures, **ceilings}:
        if name not in figures or name not in ceilings:
            found.append(f"{name}: the figures and {CEILINGS} don't both have it")
            continue
        value, ceiling, step = figures[name].value, ceilings[name], STEPS.get(name, 1)
        least = -(-value // step) * step
        if least > ceiling:
            found.append(
                "\n  ".join([f"{name}: {value} is above the ceiling of {ceiling}", *map(str, figures[name].counted)])
            )
        elif least < ceiling:
            found.append(f"{name}: {value} is below the ceiling of {ceiling}: write {least} into {CEILINGS}")
    return found


def values(found: Mapping[str, Figure]) -> str:
    """Return a line for each figure: its value and its name."""
    return "\n".join(f"{figure.value:>8,}  {name}" for name, figure in found.items())


def compared(there: Sequence[SourceFile], here: Sequence[SourceFile]) -> str:
    """Return a line for each figure, and for the statements of each folder: both values, and the name."""
    before, now = _with_folders(there), _with_folders(here)
    rows = [(f"{before.get(name, 0):,}", f"{now.get(name, 0):,}", name) for name in {**now, **before}]
    return "\n".join(f"{old:>8} {new:>8}  {name}".rstrip() for old, new, name in [("there", "here", ""), *rows])


def _with_folders(files: Sequence[SourceFile]) -> dict[str, int]:
    sizes = {f"statements in {folder}": size for folder, size in sorted(folder_sizes(files).items())}
    return {name: figure.value for name, figure in figures(files).items()} | sizes
