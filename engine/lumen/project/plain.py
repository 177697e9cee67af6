"""Use a Python dict, or a YAML file on its own, in place of a file of a project."""

from collections.abc import Mapping
from dataclasses import fields
from pathlib import Path
from typing import Any, TypeVar

from lumen.errors import ProjectError, UsageError
from lumen.language.diagnostics import Code, Diagnostic, NodePath, Place, has_errors
from lumen.project.complaints import WRONG_TYPE
from lumen.project.document import MAX_NODE_DEPTH, MAX_NODES, TOO_LARGE, Document, NodeSpan
from lumen.project.files import MAX_FILE_BYTES
from lumen.project.yaml_reader import parse
from lumen.upkeep.regular_files import read_regular

D = TypeVar("D")


def derived(into: type[D], value: Any) -> D:
    """Return the same value as an instance of `into`, a class that is derived from the value's and adds no fields."""
    return into(**{field.name: getattr(value, field.name) for field in fields(value)})


def plain_document(name: str, data: Any) -> tuple[Document | None, list[Diagnostic]]:
    """Return a document of this data, and findings about values that no YAML file could hold; these become null.

    Keys that are not texts are reported too, and left out. The document is None if the data is too large, as a dict
    that contains itself is. Instead of a line, the place of a node has its dotted path: `tour (states.idle.on.face)`.
    """
    reader = _Reader(name)
    plain = reader.read(data, ())
    return None if reader.full else Document(name, plain, reader.spans), reader.diagnostics


class _Reader:
    def __init__(self, name: str) -> None:
        self.name = name
        self.spans: dict[NodePath, NodeSpan] = {}
        self.diagnostics: list[Diagnostic] = []
        self.full = False

    def read(self, value: Any, path: NodePath) -> Any:
        place = self.place(path)
        self.spans[path] = NodeSpan(place, place)
        if len(path) > MAX_NODE_DEPTH or len(self.spans) > MAX_NODES:
            self.overflow(path)
            return None
        match value:
            case Mapping():
                return {k: self.read(v, (*path, k)) for k, v in value.items() if self.is_key(k, path)}
            case list() | tuple():
                return [self.read(item, (*path, i)) for i, item in enumerate(value)]
            case None | bool() | int() | float() | str():
                return value
        hint = "use texts, numbers, true, false, null, lists and dicts"
        self.say(WRONG_TYPE, path, f"a {type(value).__name__} can't be written to a file", hint)
        return None

    def overflow(self, path: NodePath) -> None:
        if not self.full:
            self.full = True
            what = (
                f"deeper than {MAX_NODE_DEPTH} levels"
                if len(path) > MAX_NODE_DEPTH
                else f"more than {MAX_NODES:,} values"
            )
            self.say(
                TOO_LARGE,
                path,
                f"this is too large to be read: {what}",
                "use fewer levels, and no dict that contains itself",
            )

    def is_key(self, key: object, path: NodePath) -> bool:
        if not isinstance(key, str):
            self.say(WRONG_TYPE, path, f"the key {key!r} is not a text", "put quotes around it")
        return isinstance(key, str)

    def say(self, code: Code, path: NodePath, message: str, hint: str) -> None:
        self.diagnostics.append(code.at(self.place(path), message, hint))

    def place(self, path: NodePath) -> Place:
        shown = ".".join(map(str, path[:12])) + (" …" if len(path) > 12 else "")
        return Place(f"{self.name} ({shown})" if path else self.name)


def parse_file(path: Path) -> tuple[Document | None, list[Diagnostic]]:
    """Return the document in a file, None if the file can't be parsed, and the findings.

    Raises UsageError if the file can't be read.
    """
    try:
        return parse(str(path), read_regular(path, MAX_FILE_BYTES))
    except OSError as error:
        raise UsageError(f"can't read {path}: {(error.strerror or str(error)).lower()}") from None


def read_document(path: Path) -> Document:
    """Return the document in a file. Raises UsageError if it can't be read, ProjectError if it is not YAML."""
    document, diagnostics = parse_file(path)
    if document is None or has_errors(diagnostics):
        raise ProjectError(diagnostics)
    return document
