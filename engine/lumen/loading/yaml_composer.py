"""The nodes of a YAML file, composed from libyaml's events.

libyaml's own composer calls itself for every level: 60,000 brackets end the process. Here depth and number are counted
event by event, an alias as all that it stands for, and what is too much ends the reading there, before it is parsed any
further.
"""

from collections.abc import Callable
from typing import Any

import yaml
from yaml.composer import ComposerError

from lumen.loading.document import MAX_NODE_DEPTH, MAX_NODES

MAX_TAG_DIRECTIVES = 100
"""libyaml compares each with all before it."""

_TEXT, _LIST, _MAP = "tag:yaml.org,2002:str", "tag:yaml.org,2002:seq", "tag:yaml.org,2002:map"
PLAIN_TAGS = frozenset((_TEXT, _LIST, _MAP))
"""The tags of nodes that have none in the file."""


class TooLargeError(Exception):
    """The file holds too much, in words, from this mark on."""

    def __init__(self, what: str, mark: Any) -> None:
        super().__init__(what)
        self.mark = mark


def compose(text: str) -> yaml.Node | None:
    """The root of the file's only document, None where it holds nothing; tags of plain scalars are not resolved.

    Raises TooLargeError, or a YAMLError for what is not YAML.
    """
    if text.count("%TAG") > MAX_TAG_DIRECTIVES:
        raise TooLargeError(f"more than {MAX_TAG_DIRECTIVES} tag directives", None)
    loader = yaml.CSafeLoader(text)
    try:
        return _Composer(loader).document()
    finally:
        loader.dispose()


class _Composer:
    def __init__(self, loader: yaml.CSafeLoader) -> None:
        self._next: Callable[[], Any] = loader.get_event
        self._anchors: dict[str, yaml.Node] = {}
        self._sizes: dict[str, int] = {}
        self._count = 0

    def document(self) -> yaml.Node | None:
        self._next()  # the stream begins
        if isinstance(start := self._next(), yaml.StreamEndEvent):
            return None
        root = self._node(self._next(), 0)
        self._next()  # the document ends
        if not isinstance(another := self._next(), yaml.StreamEndEvent):
            expected, problem = "expected a single document in the stream", "but found another document"
            raise ComposerError(expected, start.start_mark, problem, another.start_mark)
        return root

    def _node(self, event: Any, depth: int) -> yaml.Node:
        if depth > MAX_NODE_DEPTH:
            raise TooLargeError(f"nested deeper than {MAX_NODE_DEPTH} levels", event.start_mark)
        kind, before = type(event), self._count
        self._add(1, event)
        if kind is yaml.AliasEvent:
            return self._meant(event)
        node: yaml.Node
        if kind is yaml.ScalarEvent:
            node = yaml.ScalarNode(event.tag or _TEXT, event.value, event.start_mark, event.end_mark, event.style)
            self._named(event, node)
        else:
            node = self._list(event, depth + 1) if kind is yaml.SequenceStartEvent else self._map(event, depth + 1)
        if event.anchor is not None:
            self._sizes[event.anchor] = self._count - before
        return node

    def _add(self, nodes: int, event: Any) -> None:
        self._count += nodes
        if self._count > MAX_NODES:
            raise TooLargeError(f"more than {MAX_NODES:,} values", event.start_mark)

    def _list(self, event: Any, depth: int) -> yaml.Node:
        node = self._named(event, yaml.SequenceNode(event.tag or _LIST, [], event.start_mark, None, event.flow_style))
        while type(inner := self._next()) is not yaml.SequenceEndEvent:
            node.value.append(self._node(inner, depth))
        node.end_mark = inner.end_mark
        return node

    def _map(self, event: Any, depth: int) -> yaml.Node:
        node = self._named(event, yaml.MappingNode(event.tag or _MAP, [], event.start_mark, None, event.flow_style))
        while type(inner := self._next()) is not yaml.MappingEndEvent:
            key = self._node(inner, depth)
            node.value.append((key, self._node(self._next(), depth)))
        node.end_mark = inner.end_mark
        return node

    def _named(self, event: Any, node: yaml.Node) -> yaml.Node:
        """The node, known by its anchor from here on."""
        if event.anchor is not None:
            if (first := self._anchors.get(event.anchor)) is not None:
                context = "found duplicate anchor; first occurrence"
                raise ComposerError(context, first.start_mark, "second occurrence", event.start_mark)
            self._anchors[event.anchor] = node
        return node

    def _meant(self, event: Any) -> yaml.Node:
        """The node that an alias stands for."""
        if event.anchor not in self._anchors:
            raise ComposerError(None, None, "found undefined alias", event.start_mark)
        if event.anchor not in self._sizes:
            raise TooLargeError("an alias stands within what it stands for", event.start_mark)
        self._add(self._sizes[event.anchor] - 1, event)
        return self._anchors[event.anchor]
