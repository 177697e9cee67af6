"""Use a Python dict in place of a file: it is checked to be plain data, and the place of a node is its dotted path."""

from collections.abc import Mapping
from typing import Any

from lumen.language.diagnostics import Code, Diagnostic, NodePath, Place
from lumen.project.complaints import WRONG_TYPE
from lumen.project.document import MAX_NODE_DEPTH, MAX_NODES, TOO_LARGE, Document, NodeSpan


def plain_document(name: str, data: Any) -> tuple[Document | None, list[Diagnostic]]:
    """Return a document of this data, and findings about values that no YAML file could hold; these become null.

    The document is None if the data is too large, as a dict that contains itself is. Instead of a line, the place of a
    node has its dotted path: `tour (states.idle.on.face)`.
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
