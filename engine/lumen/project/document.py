"""A document: the plain data of a file and the place of every node in it.

With these, any later message can point at the author's text by the path of a node.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, NamedTuple

from lumen.language.diagnostics import ERROR, Code, NodePath, Place

TOO_LARGE = Code("too-large", "text", ERROR, "a file is too large, or nested too deeply")


MAX_NODE_DEPTH = 100
"""The maximum nesting depth of nodes in a document."""

MAX_NODES = 200_000
"""The maximum number of nodes in a document; those of an alias count at each place of use."""


class NodeSpan(NamedTuple):
    """The place of a node's key (None in a list and at the root) and the place of its value."""

    key: Place | None
    value: Place


@dataclass(frozen=True)
class Document:
    """One file: its path relative to the project, its text, its plain data, and the place of each node."""

    file: str
    data: Any
    spans: Mapping[NodePath, NodeSpan] = field(default_factory=dict, repr=False, compare=False)
    """The place of each node by the node's path."""
    text: str = field(default="", repr=False, compare=False)
    dropped: frozenset[str] = field(default=frozenset(), repr=False, compare=False)
    """The words under duplicate keys, which are not read."""

    def value(self, path: NodePath) -> Any:
        """Return the plain data at a path. Raises KeyError, IndexError or TypeError if the path leads to nothing."""
        node = self.data
        for step in path:
            node = node[step]
        return node

    def find(self, path: NodePath) -> Any:
        """Return the plain data at a path, or None if the path leads to nothing."""
        try:
            return self.value(path)
        except (KeyError, IndexError, TypeError):
            return None

    def place(self, path: NodePath, *, key: bool = False) -> Place:
        """Return the place of the node at `path`, or of its key; if it is absent, that of the nearest node above.

        For a missing node, that is the key of its parent, which is the line to look at if something is absent.
        """
        if path in self.spans:
            span = self.spans[path]
            return span.key if key and span.key else span.value
        while path:
            path = path[:-1]
            if path in self.spans:
                span = self.spans[path]
                return span.key or span.value._replace(end_line=span.value.line, end_column=span.value.column + 1)
        return Place(self.file)
