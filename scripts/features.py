"""Check that each capability is in one folder: imports of features, and modules that are too small."""

import ast
from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence

from scopes import Place
from source_files import SourceFile

SMALL = 50
"""A module with fewer lines needs a second reader, or a reason."""
ALONE: Mapping[str, str] = {
    "cli/report.py": "imported only after a fault, with the modules that describe it",
    "features/answers/meaning.py": "knows numpy only for types: the retriever imports it when vectors are there",
    "features/answers/server_vectors.py": "one of three sources of vectors, each with limits of its own",
    "features/editor/server.py": "imported after the command line is read: pygls needs a third of a second",
    "features/naoqi/offers.py": "the names that the robot's row may import without a connection",
}
"""Small modules with one reader, and why they are separate files."""
SHARED: Mapping[str, str] = {
    "motion/gait/swing.py": "part of the gait, which the simulation follows",
    "project/formats/behavior_data.py": "what every reader of charts of other tools needs, also one of a package",
    "project/formats/encodings.py": "what every reader of text files of other tools needs, also one of a package",
    "project/formats/foreign_json.py": "what every reader of JSON of other tools needs, also one of a package",
    "project/message_fields.py": "the fields of a route's schema, which belong to the project",
    "run/captions.py": "the words of a transcript, which pictures of charts show too",
    "run/new_saying.py": "saved files, as `run/new_passage.py`, beside which it is read",
}
"""Modules of the core that only one feature imports, and why they belong to the core."""


def imports_by_core(files: Sequence[SourceFile]) -> Iterator[Place]:
    """Yield the imports of features by the core."""
    for file, line, name in _imports(files):
        if _feature(file) is None:
            yield Place(file, line, f"imports {name}")


def imports_by_features(files: Sequence[SourceFile]) -> Iterator[Place]:
    """Yield the imports of one feature by another."""
    for file, line, name in _imports(files):
        if (own := _feature(file)) is not None and own != name.split(".")[2]:
            yield Place(file, line, f"imports {name}")


def small_modules(files: Sequence[SourceFile]) -> Iterator[Place]:
    """Yield the modules with fewer than `SMALL` lines that only a module of the same folder imports, without a reason.

    A module named by an import string has a reader elsewhere.
    """
    sizes = {file.path: file.text.count("\n") for file in files if not file.path.endswith("__init__.py")}
    readers: dict[str, set[str]] = defaultdict(set)
    named: set[str] = set()
    for file in files:
        for module in _imported(file):
            readers[_path(module)].add(file.path)
        named.update(map(_path, _import_strings(file)))
    for path, lines in sizes.items():
        only = readers[path]
        if lines < SMALL and len(only) == 1 and path not in named and path not in ALONE:
            reader = next(iter(only))
            if reader.rpartition("/")[0] == path.rpartition("/")[0] and not reader.endswith("__init__.py"):
                yield Place(path, 1, f"has {lines} lines, and only {reader} imports it")


def files_elsewhere(files: Sequence[SourceFile]) -> Iterator[Place]:
    """Yield the modules of the core that only modules in one feature's folder name, without a reason."""
    paths = {file.module: file.path for file in files}
    readers: dict[str, set[str | None]] = defaultdict(set)
    for file in files:
        for name in _named(file):
            if (path := paths.get(name)) is not None and path != file.path:
                readers[path].add(_feature(file.path))
    for path, features in readers.items():
        core = _feature(path) is None and path not in SHARED and not path.endswith("__init__.py")
        if core and len(features) == 1 and (feature := next(iter(features))) is not None:
            yield Place(path, 1, f"belongs to features/{feature}: nothing else imports it")


def elsewhere_by_feature(files: Sequence[SourceFile]) -> dict[str, list[str]]:
    """Return each feature with its files outside of its folder."""
    found: dict[str, list[str]] = {name: [] for file in files if (name := _feature(file.path)) is not None}
    for place in files_elsewhere(files):
        found[place.why.removeprefix("belongs to features/").partition(":")[0]].append(place.path)
    return found


def _named(file: SourceFile) -> Iterator[str]:
    """Yield the modules that a file may name: in an import, or in an import string."""
    yield from _imported(file)
    yield from _import_strings(file)


def _imported(file: SourceFile) -> Iterator[str]:
    """Yield the modules that a file imports, and the names from them, which may be modules too."""
    for node in file.of(ast.ImportFrom):
        if node.module:
            yield from (node.module, *(f"{node.module}.{alias.name}" for alias in node.names))
    for node in file.of(ast.Import):
        yield from (alias.name for alias in node.names)


def _import_strings(file: SourceFile) -> Iterator[str]:
    """Yield the part before the colon of each text in a file; that of an import string is a module."""
    for node in file.of(ast.Constant):
        if isinstance(node.value, str):
            yield node.value.partition(":")[0]


def _imports(files: Sequence[SourceFile]) -> Iterator[tuple[str, int, str]]:
    """Yield file, line and module of each import of a module in a feature's folder."""
    folders = {path.split("/")[1] for file in files if (path := file.path).count("/") > 1 and _feature(path)}
    for file in files:
        found = [(node.lineno, node.module or "") for node in file.of(ast.ImportFrom)]
        found += [(node.lineno, alias.name) for node in file.of(ast.Import) for alias in node.names]
        for line, name in found:
            parts = name.split(".")
            if parts[:2] == ["lumen", "features"] and len(parts) > 2 and parts[2] in folders:
                yield file.path, line, name


def _feature(path: str) -> str | None:
    """Return the feature in whose folder a file is; None for a file of the core."""
    parts = path.split("/")
    return parts[1] if parts[0] == "features" and len(parts) > 2 else None


def _path(module: str) -> str:
    return module.removeprefix("lumen.").replace(".", "/") + ".py"
