"""A document: the plain data of a file beside the place of every node in it.

By them every later message can point at the author's text by the path of the node.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, NamedTuple

from lumen.language.diagnostics import ERROR, Code, NodePath, Place

TOO_LARGE = Code("too-large", "text", ERROR, "a file is too large, or nested too deeply")


MAX_NODE_DEPTH = 100
"""Levels of nodes within one another that a document may have."""

MAX_NODES = 200_000
"""Nodes that a document may have, those of an alias counted wherever it stands."""


class NodeSpan(NamedTuple):
    """Where a node stands: its key (None in a list and at the root) and its value."""

    key: Place | None
    value: Place


@dataclass(frozen=True)
class Document:
    """One file: its path relative to the project, its text, the plain data in it, and where each node stands.

    `dropped` are the words under keys that stand a second time, and that are not read.
    """

    file: str
    data: Any
    spans: Mapping[NodePath, NodeSpan] = field(default_factory=dict, repr=False, compare=False)
    text: str = field(default="", repr=False, compare=False)
    dropped: frozenset[str] = field(default=frozenset(), repr=False, compare=False)

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
        """The place of the node at `path`, or of its key; of the nearest node above it where there is none.

        Where the node itself is missing, that is the key of its parent: what to look at when something is absent.
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
